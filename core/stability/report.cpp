#include "core/stability/report.h"

#include <algorithm>

#include "core/study/svg.h"

namespace orrery {
namespace {

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit == "1" ? number : number + " " + unit;
}

// Escapes "|" for a cell of a Markdown table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string row_of(const StabilityResult& result) {
  const StabilityRow& row = result.row;
  return "| " + std::string(row.id) + " | **" + row.name + "**: " + cell(row.quantity) + " | " +
         cell(row.known) + " | " + figure_text(result.figures.known, row.unit) + " | " + cell(row.ours) +
         " | " + figure_text(result.figures.ours, row.unit) + " | " +
         figure_text(row.ours_at_most, row.unit) + (result.holds() ? "" : ", **exceeded**") + " |\n";
}

constexpr const char* kIntroduction = R"(# Numerical stability

Each row computes one quantity twice: with a known method, as published, and with the method that orrery uses. Numbers
are errors; 0 is exact. A test checks that the error of orrery's method is within its bound. The
[catalogue](stability-catalogue.md) describes the ids, which tests use too.

`orrery stability` measures all rows with the running build. `--json` prints JSON, and the service has the endpoint
`GET /v1/stability`. The results are the same on every machine. `orrery stability --docs docs` writes this page, and a
test compares the page with the measurements.

| id | quantity | known method | error | method of orrery | error | bound |
|---|---|---|---|---|---|---|
)";

constexpr const char* kSpeed = R"(
## Speed and accuracy

`orrery stability --speed` compares methods for the same task in interleaved runs. It prints the error of each method
and its CPU time relative to the first method of its group. The chart shows the results of one machine:

![Relative CPU time and error of methods, measured on one machine](pictures/speed.svg)
)";

}  // namespace

std::string figure_text(double value, const char* unit) {
  std::string number = printed("%.2g", value);
  if (value >= 100 && value < 1e5) number = printed("%.0f", value);
  return with_unit(number, unit);
}

std::string stability_text(std::span<const StabilityResult> results) {
  std::string text;
  std::size_t kept = 0;
  for (const StabilityResult& result : results) {
    const StabilityRow& row = result.row;
    kept += result.holds();
    text += printed("%-15s", row.id) + row.quantity + "\n";
    text += printed("  %12s  ", figure_text(result.figures.known, row.unit).c_str()) + row.known + "\n";
    text += printed("  %12s  ", figure_text(result.figures.ours, row.unit).c_str()) + row.ours + "; " +
            (result.holds() ? "within" : "EXCEEDS") + " " + figure_text(row.ours_at_most, row.unit) + "\n";
  }
  return text + printed("%zu of %zu rows are within their bounds\n", kept, results.size());
}

std::string stability_markdown(std::span<const StabilityResult> results) {
  std::string text = kIntroduction;
  for (const StabilityResult& result : results) text += row_of(result);
  for (const StabilityResult& result : results)
    if (const auto& chart = result.figures.chart)
      text += "\n![" + chart->title + "](pictures/stability-" + chart->name + ".svg)\n";
  return text + kSpeed;
}

}  // namespace orrery
