#include "core/stability/report.h"

#include <algorithm>

#include "core/study/svg.h"

namespace orrery {
namespace {

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit == "1" ? number : number + " " + unit;
}

// Escapes a text for a table cell.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

std::string row_of(const StabilityResult& result) {
  const StabilityRow& row = result.row;
  return "| " + std::string(row.id) + " | **" + row.name + "**: " + cell(row.quantity) + " | " +
         cell(row.known) + " | " + figure_text(result.figures.known, row.unit) + " | " + cell(row.ours) +
         " | " + figure_text(result.figures.ours, row.unit) + " | " +
         figure_text(row.ours_at_most, row.unit) + (result.holds() ? "" : ", **not kept**") + " |\n";
}

constexpr const char* kIntroduction = R"(# Where numerical methods fail

Each row computes one thing twice: by a known method, as its source prints it, and by the code that renders here. Both
are measured by what they are off: 0 is exact. The bound is what a test holds of this program's method. Tests that are
about the same thing name the same id.

`orrery stability` measures all of it on the build at hand (`--json` for programs; `GET /v1/stability` of the service).
The figures are the same on every machine, so this page is written by `orrery stability --docs docs`, and a test compares
it with what the program measures.

| id | what is computed | known method | is off by | this program's method | is off by | bound |
|---|---|---|---|---|---|---|
)";

constexpr const char* kSpeed = R"(
## Speed beside accuracy

`orrery stability --speed` has methods that do the same take turns, and prints their CPU time over that of the first of
their group beside what they are off. Measured on one machine:

![Speed beside accuracy, measured on one machine](pictures/speed.svg)
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
            (result.holds() ? "keeps" : "DOES NOT KEEP") + " " + figure_text(row.ours_at_most, row.unit) +
            "\n";
  }
  return text + printed("%zu of %zu rows keep their bounds\n", kept, results.size());
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
