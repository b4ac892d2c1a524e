#include "core/study/chart.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <random>

// Tests the evaluation of measurements: front, table and chart.
namespace orrery::test {
namespace {

struct Round {
  double cpu_ms, rmse;
};

Point point(const std::vector<Round>& rounds, int samples = 1) {
  Point made{.configuration = {.technique = "whitted", .max_depth = 5, .samples = samples},
             .rounds = {},
             .accelerator = "bvh",
             .plan = {},
             .picture_plan = {}};
  for (const Round& round : rounds) {
    Measurement measured;
    measured.cpu_ms = round.cpu_ms;
    measured.difference.rmse = round.rmse;
    made.rounds.push_back(measured);
  }
  return made;
}
Point point(double cpu_ms, double rmse, int samples = 1) { return point({{cpu_ms, rmse}}, samples); }

std::vector<ParetoStatus> front_of(std::vector<Point> points, double floor = 0) {
  mark_pareto_front(points, floor);
  std::vector<ParetoStatus> statuses;
  for (const Point& p : points) statuses.push_back(p.pareto_status);
  return statuses;
}

using testing::ElementsAre;
using enum ParetoStatus;

TEST(ParetoFront, ContainsNonDominatedPoints) {
  EXPECT_THAT(front_of({point(1, 0.5), point(2, 0.1), point(3, 0.2)}), ElementsAre(front, front, dominated));
  EXPECT_THAT(front_of({point(3, 0.2), point(2, 0.1), point(1, 0.5)}), ElementsAre(dominated, front, front));
  EXPECT_THAT(front_of({point(1, 0), point(2, 0)}), ElementsAre(front, dominated));
}

TEST(ParetoFront, IgnoresErrorDifferencesBelowOnePercent) {
  EXPECT_THAT(front_of({point(1, 0.1), point(2, 0.0995)}), ElementsAre(front, dominated));
  EXPECT_THAT(front_of({point(1, 0.1), point(2, 0.0985)}), ElementsAre(front, front));
  EXPECT_THAT(front_of({point(1, 0.1), point(2, 0.0995), point(3, 0.0989)}),
              ElementsAre(front, dominated, front));
}

TEST(ParetoFront, RaisesErrorsToFloor) {
  EXPECT_THAT(front_of({point(1, 0.01), point(2, 0.002), point(3, 0.001)}), ElementsAre(front, front, front));
  EXPECT_THAT(front_of({point(1, 0.01), point(2, 0.002), point(3, 0.001)}, 0.002),
              ElementsAre(front, front, dominated));
}

TEST(ParetoFront, LeavesIndistinguishablePointsUndecided) {
  const Point quick = point({{1, 0.1}, {1.01, 0.1}, {0.99, 0.1}});
  EXPECT_THAT(front_of({quick, point({{2, 0.12}, {2.1, 0.13}, {1.9, 0.12}})}), ElementsAre(front, dominated));
  // The second point may be more accurate or less accurate.
  EXPECT_THAT(front_of({quick, point({{2, 0.12}, {2.1, 0.07}, {1.9, 0.15}})}), ElementsAre(front, undecided));
  // The second point is less accurate, but may be faster.
  EXPECT_THAT(front_of({quick, point({{0.5, 0.2}, {2.9, 0.2}, {1.1, 0.2}})}), ElementsAre(front, undecided));
  EXPECT_THAT(front_of({point(1, 0.1), point(1, 0.1)}), ElementsAre(undecided, undecided));
}

TEST(ParetoFront, ComparesPointsRoundByRound) {
  // Rounds differ much more than points, because both points of a round have the same seed and load.
  EXPECT_THAT(
      front_of({point({{1, 0.10}, {2, 0.20}, {3, 0.15}}), point({{1.5, 0.10}, {2.5, 0.20}, {3.5, 0.15}})}),
      ElementsAre(front, dominated));
}

// Two common rounds are too few to decide, but the intervals over all rounds of each point do.
TEST(ParetoFront, ExcludesPointsDominatedBeyondIntervals) {
  const Point slow =
      point({{20, 0.2}, {4, 0.2}, {20.1, 0.2}, {20, 0.2}, {20.1, 0.2}, {20, 0.2}, {20.1, 0.2}, {20, 0.2}});
  EXPECT_THAT(front_of({point({{1, 0.1}, {1.01, 0.1}}), slow}), ElementsAre(front, dominated));
}

TEST(Point, AveragesRounds) {
  Point p = point(5, 0.3);
  p.rounds.push_back(point(100, 0.4).rounds[0]);
  p.rounds.push_back(point(6, 0).rounds[0]);
  EXPECT_DOUBLE_EQ(p.cpu_ms(), 37);
  EXPECT_DOUBLE_EQ(p.rmse(), std::sqrt((0.09 + 0.16) / 3));
  EXPECT_NEAR(p.rmse_sd(), 0.20816659994661327, 1e-12);  // for 0.3, 0.4, 0
  EXPECT_EQ(point(5, 0.3).rmse_sd(), 0);
  EXPECT_EQ(p.psnr_db(), std::numeric_limits<double>::infinity());
  p.rounds[1].difference.cut_mse = 0.03;
  EXPECT_NEAR(p.psnr_db(), 20, 1e-12);
}

// Student's t of two degrees of freedom is 4.302652730 at 0.975.
TEST(Point, ReportsIntervalsOfMeans) {
  EXPECT_FALSE(point(5, 0.3).rmse_interval());
  EXPECT_EQ(point(5, 0.3).max_rmse(), 0.3);
  const Point p = point({{5, 0.3}, {7, 0.4}, {6, 0.2}});
  const double half = 4.302652730 / std::sqrt(3);
  EXPECT_NEAR(p.cpu_ms_interval()->low, 6 - half, 0.02);
  EXPECT_NEAR(p.cpu_ms_interval()->high, 6 + half, 0.02);
  EXPECT_NEAR(p.rmse_interval()->low, 0.3 - 0.1 * half, 0.002);
  EXPECT_NEAR(p.rmse_interval()->high, 0.3 + 0.1 * half, 0.002);
  EXPECT_EQ(p.max_rmse(), p.rmse_interval()->high);
  EXPECT_EQ(point({{1, 0.3}, {9, 0.3}}).cpu_ms_interval()->low, 0) << "times cannot be negative";
  const Point same = point({{5, 0.3}, {5, 0.3}});
  EXPECT_NEAR(same.rmse_interval()->high - same.rmse_interval()->low, 0, 1e-12);
}

// For normally distributed values, 95 % of the intervals contain the mean, for any number of values.
TEST(Point, CoversMeanAtStatedRate) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.3, 0.05);
  for (const std::size_t rounds : {2U, 3U, 8U}) {
    int inside = 0;
    constexpr int kTrials = 4000;
    for (int i = 0; i < kTrials; ++i) {
      std::vector<double> values(rounds);
      for (double& value : values) value = normal(random);
      const Interval interval = *mean_interval(values);
      inside += interval.low <= 0.3 && 0.3 <= interval.high;
    }
    EXPECT_NEAR(inside / double(kTrials), 0.95, 0.012) << rounds;
  }
}

Chart chart() {
  Chart chart;
  chart.title = "a <b> & \"c\"\n\x01\xEF\xBF\xBF";
  chart.size = {60, 40};
  chart.measured = {30, 20};
  chart.reference = {"whitted", 5, true, 64};
  chart.reference_rmse = 0.001;
  for (const int samples : {1, 4, 16}) chart.points.push_back(point(2.0 * samples, 0.1 / samples, samples));
  chart.points.push_back(point(40, 0, 64));
  mark_pareto_front(chart.points, chart.reference_rmse);
  return chart;
}

TEST(Chart, ListsFrontByCost) {
  Chart mixed = chart();
  std::swap(mixed.points[0], mixed.points[2]);
  EXPECT_THAT(mixed.front(), ElementsAre(2, 1, 0, 3));
}

TEST(Chart, PredictsFullSizeTimeFromPixelsAndThreads) {
  Chart quartered = chart();
  EXPECT_DOUBLE_EQ(quartered.full_seconds(500), 2);
  quartered.threads = 8;
  EXPECT_DOUBLE_EQ(quartered.full_seconds(500), 0.25);
  EXPECT_EQ(narrowed({1000, 3}, 10).height, 1);
  EXPECT_EQ(narrowed({640, 480}, 320).height, 240);
}

TEST(Chart, RecommendsCheapestPointBelowEachError) {
  Chart all = chart();  // errors of 0.1, 0.025, 0.00625 and 0
  const auto found = recommendations(all);
  std::vector<std::pair<double, std::size_t>> pairs;
  for (const Recommendation& r : found) pairs.emplace_back(r.error, r.point);
  EXPECT_THAT(pairs, ElementsAre(std::pair(0.05, 1), std::pair(0.01, 2), std::pair(0.0001, 3)));
  all.points[1] = point({{8, 0.02}, {8, 0.2}, {8, 0.02}}, 4);  // the interval extends far beyond 0.05
  EXPECT_EQ(recommendations(all).front().point, 2U);
}

// Returns element names in the order of their start tags. Fails the test if end tags do not match.
std::vector<std::string> elements(const std::string& xml) {
  std::vector<std::string> all, open;
  for (std::size_t from = xml.find('<'); from != std::string::npos; from = xml.find('<', from + 1)) {
    const std::string tag = xml.substr(from + 1, xml.find('>', from) - from - 1);
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag[0] == '/') {
      EXPECT_EQ(open.empty() ? "" : "/" + open.back(), tag);
      if (!open.empty()) open.pop_back();
      continue;
    }
    all.push_back(name);
    if (tag.back() != '/') open.push_back(name);
  }
  EXPECT_TRUE(open.empty());
  return all;
}

TEST(ChartSvg, IsWellFormedForAnyTitle) {
  const std::string svg = svg_of(chart());
  const auto found = elements(svg);
  EXPECT_EQ(found.front(), "svg");
  EXPECT_EQ(std::count(found.begin(), found.end(), "circle"), 4 + 1);  // the points and one in the legend
  EXPECT_THAT(svg, testing::HasSubstr("a &lt;b&gt; &amp; \"c\"  ?</text>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(ChartSvg, SupportsFewAndEqualPoints) {
  Chart one = chart();
  one.reference_rmse = 0;
  for (const std::size_t count : {3U, 1U}) {
    one.points.erase(one.points.begin(), one.points.end() - std::ptrdiff_t(count));
    const std::string svg = svg_of(one);
    elements(svg);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(ChartSvg, MarksUndecidedAndUnresolvedPoints) {
  using testing::HasSubstr;
  using testing::Not;
  Chart unsure = chart();
  EXPECT_THAT(svg_of(unsure), Not(HasSubstr("possibly on the Pareto front")));
  unsure.points[1].pareto_status = undecided;
  const std::string svg = svg_of(unsure);
  const std::string mark = svg.substr(svg.find("<g id=\"point-1\">"), svg.find("</g>", svg.find("point-1")));
  EXPECT_THAT(mark, HasSubstr("fill=\"#ffffff\""));
  EXPECT_THAT(mark, HasSubstr("possibly on the Pareto front"));
  EXPECT_THAT(mark, HasSubstr("a5 5 0 0 0 0 10z"));
  EXPECT_THAT(svg, HasSubstr("below the error of the reference"));
  EXPECT_THAT(svg, HasSubstr("fill=\"#999999\""));
}

TEST(ChartSvg, LabelsZeroError) {
  using testing::HasSubstr;
  Chart same = chart();
  EXPECT_THAT(svg_of(same), HasSubstr(">0</text>"));
  same.points.pop_back();
  EXPECT_THAT(svg_of(same), testing::Not(HasSubstr(">0</text>")));
  same.points = {point(1, 0)};
  same.reference_rmse = 0;
  EXPECT_THAT(svg_of(same), HasSubstr(">0</text>"));
}

TEST(ChartSvg, SpansAllErrors) {
  using testing::HasSubstr;
  using testing::Not;
  Chart bright = chart();
  bright.reference_rmse = 3000;
  bright.points = {point(1, 90'000), point(2, 20'000)};
  EXPECT_THAT(svg_of(bright), AllOf(HasSubstr(">1000</text>"), HasSubstr(">100000</text>"),
                                    Not(HasSubstr(">1</text>\n<text x=\"76"))));
}

TEST(ChartSvg, ShortensLongTitle) {
  Chart chart_of_long = chart();
  chart_of_long.title.clear();
  for (int i = 0; i < 200; ++i) chart_of_long.title += "\xC3\xA9";
  const std::string svg = svg_of(chart_of_long);
  EXPECT_THAT(svg, testing::HasSubstr("\xC3\xA9...</text>"));
  EXPECT_EQ(svg.find("\xC3..."), std::string::npos);
}

}  // namespace
}  // namespace orrery::test
