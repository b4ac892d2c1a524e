#include "core/study/chart.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

// What is made of measurements: front, table, drawing.
namespace orrery::test {
namespace {

Point point(double cpu_ms, double rmse, int samples = 1) {
  Measurement sighting;
  sighting.cpu_ms = cpu_ms;
  sighting.difference.rmse = rmse;
  return {.configuration = {.technique = "whitted", .max_depth = 5, .samples = samples},
          .rounds = {sighting},
          .accelerator = "bvh"};
}

std::vector<bool> front_of(std::vector<Point> points) {
  mark_front(points);
  std::vector<bool> front;
  for (const Point& p : points) front.push_back(p.on_front);
  return front;
}

TEST(Front, HoldsWhatNothingBeatsInBoth) {
  using testing::ElementsAre;
  EXPECT_THAT(front_of({point(1, 0.5), point(2, 0.1), point(3, 0.2)}), ElementsAre(true, true, false));
  EXPECT_THAT(front_of({point(1, 0.1), point(1, 0.2)}), ElementsAre(true, false));
  EXPECT_THAT(front_of({point(1, 0.1), point(1, 0.1)}), ElementsAre(true, false));
  EXPECT_THAT(front_of({point(3, 0.2), point(2, 0.1), point(1, 0.5)}), ElementsAre(false, true, true));
  EXPECT_THAT(front_of({point(1, 0), point(2, 0)}), ElementsAre(true, false));
}

TEST(Front, TakesAOnePercentSmallerErrorForNoSmaller) {
  EXPECT_THAT(front_of({point(1, 0.1), point(2, 0.0995)}), testing::ElementsAre(true, false));
  EXPECT_THAT(front_of({point(1, 0.1), point(2, 0.0985)}), testing::ElementsAre(true, true));
  EXPECT_THAT(front_of({point(1, 0.1), point(2, 0.0995), point(3, 0.0989)}),
              testing::ElementsAre(true, false, true));
}

TEST(Point, SumsUpItsRounds) {
  Point p = point(5, 0.3);
  p.rounds.push_back(point(100, 0.4).rounds[0]);
  EXPECT_DOUBLE_EQ(p.cpu_ms(), 52.5);
  p.rounds.push_back(point(6, 0).rounds[0]);
  EXPECT_DOUBLE_EQ(p.cpu_ms(), 6);
  EXPECT_DOUBLE_EQ(p.rmse(), std::sqrt((0.09 + 0.16) / 3));
  EXPECT_NEAR(p.rmse_sd(), 0.20816659994661327, 1e-12);  // of 0.3, 0.4, 0
  EXPECT_EQ(point(5, 0.3).rmse_sd(), 0);
  EXPECT_EQ(p.psnr_db(), std::numeric_limits<double>::infinity());
  p.rounds[1].difference.cut_mse = 0.03;
  EXPECT_NEAR(p.psnr_db(), 20, 1e-12);
}

Chart chart() {
  Chart chart;
  chart.title = "a <b> & \"c\"\n\x01\xEF\xBF\xBF";
  chart.width = 30;
  chart.height = 20;
  chart.reference = {"whitted", 5, true, 64};
  chart.reference_rmse = 0.001;
  for (const int samples : {1, 4, 16}) chart.points.push_back(point(2.0 * samples, 0.1 / samples, samples));
  chart.points.push_back(point(40, 0, 64));
  mark_front(chart.points);
  return chart;
}

// Element names in the order in which they open; fails where they do not close in turn.
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

TEST(Drawing, IsWellFormedWhateverTheTitle) {
  const std::string svg = svg_of(chart());
  const auto found = elements(svg);
  EXPECT_EQ(found.front(), "svg");
  EXPECT_EQ(std::count(found.begin(), found.end(), "circle"), 4 + 1);  // the points, and the legend's
  EXPECT_THAT(svg, testing::HasSubstr("a &lt;b&gt; &amp; \"c\"  ?</text>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Drawing, IsMadeOfFewAndEqualPointsToo) {
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

TEST(Drawing, ShowsNoDifferenceAsZero) {
  using testing::HasSubstr;
  Chart same = chart();
  EXPECT_THAT(svg_of(same), HasSubstr(">0</text>"));
  same.points.pop_back();
  EXPECT_THAT(svg_of(same), testing::Not(HasSubstr(">0</text>")));
  same.points = {point(1, 0)};
  same.reference_rmse = 0;
  EXPECT_THAT(svg_of(same), HasSubstr(">0</text>"));
}

TEST(Drawing, ReachesFromTheLeastErrorToTheLargest) {
  using testing::HasSubstr;
  using testing::Not;
  Chart bright = chart();
  bright.reference_rmse = 3000;
  bright.points = {point(1, 90'000), point(2, 20'000)};
  EXPECT_THAT(svg_of(bright), AllOf(HasSubstr(">1000</text>"), HasSubstr(">100000</text>"),
                                    Not(HasSubstr(">1</text>\n<text x=\"76"))));
}

TEST(Drawing, ShortensALongTitle) {
  Chart chart_of_long = chart();
  chart_of_long.title.clear();
  for (int i = 0; i < 200; ++i) chart_of_long.title += "\xC3\xA9";
  const std::string svg = svg_of(chart_of_long);
  EXPECT_THAT(svg, testing::HasSubstr("\xC3\xA9...</text>"));
  EXPECT_EQ(svg.find("\xC3..."), std::string::npos);
}

}  // namespace
}  // namespace orrery::test
