#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/stability/line_chart.h"
#include "core/stability/registry.h"
#include "core/stability/report.h"
#include "core/stability/speed.h"
#include "tests/support/covers.h"

namespace orrery::test {
namespace {

class Stability : public testing::TestWithParam<std::string> {};

// The known method has at least the documented error, and this project's method keeps the smaller bound.
TEST_P(Stability, KeepsBoundExceededByKnownMethod) {
  const StabilityRow& row = stability_row(GetParam().c_str());
  covers(row.id);
  const StabilityFigures figures = row.measure();
  ASSERT_TRUE(std::isfinite(figures.known) && std::isfinite(figures.ours));
  EXPECT_GE(figures.known, row.known_at_least) << row.known;
  EXPECT_LE(figures.ours, row.ours_at_most) << row.ours;
  EXPECT_GE(figures.ours, 0);
  EXPECT_LT(row.ours_at_most, row.known_at_least) << "the known method also keeps the bound";
}

std::vector<std::string> all_ids() {
  std::vector<std::string> ids;
  for (const StabilityRow& row : stability_rows()) ids.push_back(row.id);
  return ids;
}
INSTANTIATE_TEST_SUITE_P(Rows, Stability, testing::ValuesIn(all_ids()), parameter_name);

TEST(StabilityRows, HasUniqueNames) {
  const auto ids = all_ids();
  EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_THROW(stability_row("none"), std::out_of_range);
}

TEST(StabilityRows, MeasuresDeterministically) {
  for (const StabilityRow& row : stability_rows()) {
    const StabilityFigures once = row.measure(), again = row.measure();
    EXPECT_EQ(once.known, again.known) << row.id;
    EXPECT_EQ(once.ours, again.ours) << row.id;
  }
}

StabilityResult example(double ours, double at_most) {
  return {{"A0", "Example", "lengths of a | b", "m", "known method", 1, "our method", at_most, nullptr},
          {2.5, ours}};
}

TEST(StabilityReport, ReportsExceededBounds) {
  const StabilityResult good = example(0, 1e-9), bad = example(2e-9, 1e-9);
  EXPECT_TRUE(good.holds());
  EXPECT_FALSE(bad.holds());
  EXPECT_NE(stability_text(std::span(&good, 1)).find("1 of 1 rows are within"), std::string::npos);
  EXPECT_NE(stability_text(std::span(&bad, 1)).find("EXCEEDS 1e-09 m"), std::string::npos);
  EXPECT_NE(stability_markdown(std::span(&bad, 1)).find("| 2e-09 m | 1e-09 m, **exceeded** |"),
            std::string::npos);
  EXPECT_NE(stability_markdown(std::span(&good, 1)).find("lengths of a \\| b | known method | 2.5 m |"),
            std::string::npos);
}

TEST(StabilityReport, FormatsFiguresWithTwoDigitsAndUnit) {
  EXPECT_EQ(figure_text(0, "m"), "0 m");
  EXPECT_EQ(figure_text(28.6, "%"), "29 %");
  EXPECT_EQ(figure_text(128, "of 256"), "128 of 256");
  EXPECT_EQ(figure_text(2.34e-7, "1"), "2.3e-07");
}

// In a logarithmic chart, a line that is 0 everywhere is drawn in a strip below the axis.
TEST(StabilityChart, ShowsZerosBelowLogarithmicAxis) {
  LineChart chart{"example", "a < b", "x", "y", true, true, {{"known", {}}, {"ours", {}}}};
  for (const double x : {1.0, 10.0, 100.0}) {
    chart.series[0].points.push_back({x, x / 10});
    chart.series[1].points.push_back({x, 0});
  }
  const std::string svg = svg_of(chart);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_NE(svg.find("points=\"84.0,266.0 262.0,157.0 440.0,48.0 \""), std::string::npos) << svg;
  EXPECT_NE(svg.find("points=\"84.0,283.3 262.0,283.3 440.0,283.3 \""), std::string::npos) << svg;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(StabilityChart, FitsTitlesAndLegends) {
  for (const StabilityResult& result : measure_stability()) {
    const auto& chart = result.figures.chart;
    if (!chart) continue;
    EXPECT_LE(chart->title.size(), 65u) << chart->title;
    for (const auto& series : chart->series) EXPECT_LE(series.name.size(), 28u) << series.name;
  }
}

// Bar lengths are proportional to time. The slowest method of all groups has the length 350.
TEST(SpeedChart, DrawsBarForEachMethod) {
  const std::vector<SpeedGroup> groups{
      {"Number type", {{"double", 1, "reference"}, {"float", 0.5, "RMS 1e-4"}}},
      {"Structure", {{"list", 1, "reference"}, {"boxes", 2, "RMS 0"}}}};
  EXPECT_NE(speed_text(groups).find("  float                0.50  RMS 1e-4\n"), std::string::npos);
  const std::string svg = svg_of(groups);
  for (const char* bar : {"width=\"175.0\"", "width=\"87.5\"", "width=\"350.0\"", "0.50; RMS 1e-4"})
    EXPECT_NE(svg.find(bar), std::string::npos) << bar;
}

}  // namespace
}  // namespace orrery::test
