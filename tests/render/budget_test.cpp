// Compares renders under error and time budgets with references. The test controls the clock.
#include "core/budget/budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>

#include "core/plan/options.h"
#include "core/render/views.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

namespace orrery {
namespace {

using test::covers;
using test::Json;
using test::rendered;
using test::rms_difference;

RenderRequest square(int side) {
  RenderRequest r;
  r.width = r.height = side;
  return r;
}

RenderRequest with_error(int side, double error, Space space) {
  RenderRequest r = square(side);
  r.error = error;
  r.space = space;
  return r;
}

// Returns the values of an image as stored in its file. In display space these are the values of a PNG.
std::vector<double> values_of(const Film& film, Space space) {
  if (space != Space::display) return test::linear_values(film);
  std::vector<double> values;
  const Image image = film.image(PixelFormat::srgb8);
  for (const std::byte b : image.bytes()) values.push_back(std::to_integer<int>(b) / 255.0);
  return values;
}

std::vector<double> truth_of(const std::shared_ptr<const Scene>& scene, RenderRequest r, int samples) {
  r.samples = samples;
  r.error = 0;
  r.precision = Precision::double_precision;
  r.max_depth = 32;
  r.min_contribution = 1e-5;
  if (!r.seed) r.seed = 4711;
  return values_of(rendered(scene, r).film, Space::linear);
}

std::vector<double> in_space(const std::vector<double>& linear, Space space) {
  return space == Space::display ? test::shown(linear) : linear;
}

// Returns a scene of small lamps. One pixel in a hundred shows a lamp.
Json dots() {
  Json dots = test::scene_with(test::json("[]"));
  dots["materials"]["lamp"] = test::json("{'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}");
  for (int i = 0; i < 40; ++i)
    dots["objects"].push_back({{"type", "sphere"},
                               {"center", {(i % 8 - 3.5) * 0.4, (i / 8 - 2) * 0.5, 0}},
                               {"radius", 0.025},
                               {"material", "lamp"}});
  return dots;
}

// A budget for a smaller error never costs fewer rays. A budget that is reported as met is met, and every
// missed budget has a reason.
TEST(ErrorBudget, MeetsReportedError) {
  covers("certificate-29 certificate-38");
  for (const Json& json : {test::sample("paper"), test::sample("glass"), test::sample("material-metal"),
                           test::sample("cornell-box"), test::sample("technique-distributed"), dots()}) {
    const auto scene = test::load(json);
    const auto linear = truth_of(scene, square(64), 512);
    for (const Space space : {Space::display, Space::linear}) {
      const auto truth = in_space(linear, space);
      std::uint64_t cost = 0;
      for (const double error : {0.2, 0.1, 0.05, 0.025}) {
        const RenderResult result = rendered(scene, with_error(64, error, space));
        ASSERT_TRUE(result.budget);
        EXPECT_GE(result.stats.counts.rays.total(), cost) << json["title"] << " " << error;
        cost = result.stats.counts.rays.total();
        const double realised = rms_difference(values_of(result.film, space), truth);
        EXPECT_EQ(result.budget->met(), result.budget->reason.empty());
        if (result.budget->met()) {
          EXPECT_LE(realised, error) << json["title"] << " " << name_of(space);
          EXPECT_LE(*result.certificate.total().rms, error);
        } else {  // only the estimate meets an unprovable budget
          EXPECT_LE(realised, 1.1 * error) << json["title"] << " " << result.budget->reason;
        }
      }
    }
  }
}

// Pilot renders find the rays that may be omitted, so nearly all rays contribute to the image.
TEST(ErrorBudget, TracesFewExtraRays) {
  for (const char* name : {"paper", "glass", "mirrors"}) {
    const auto scene = test::load(test::sample(name));
    const RenderResult result = rendered(scene, with_error(96, 0.05, Space::display));
    RenderRequest plain;
    static_cast<RenderSettings&>(plain) = result.budget->settings;
    const auto needed = static_cast<double>(rendered(scene, plain).stats.counts.rays.total());
    EXPECT_LE(static_cast<double>(result.stats.counts.rays.total()), 1.25 * needed) << name;
  }
}

// Passes end for all pixels at once, so features hit by few samples are not darkened. Ending pixels
// individually would lose 84 % of the light of these features. The error is met for at least 95 of 100 seeds.
TEST(ErrorBudget, MeetsErrorWithoutBiasOverSeeds) {
  covers("light-48 certificate-25");
  Json path = dots();
  path["render"] = {{"technique", "path"}};
  for (const Json& json : {test::sample("cornell-box"), path}) {
    const auto scene = test::load(json);
    const auto truth = truth_of(scene, square(48), 2048);
    double true_mean = 0;
    for (const double value : truth) true_mean += value;
    for (const Space space : {Space::linear, Space::display}) {
      const auto shown = in_space(truth, space);
      int held = 0;
      double mean = 0;
      RenderRequest r = with_error(48, 0.05, space);
      for (r.seed = 0; *r.seed < 100; ++*r.seed) {
        const RenderResult result = rendered(scene, r);
        held += rms_difference(values_of(result.film, space), shown) <= 1.1 * *r.error;
        for (const double value : values_of(result.film, Space::linear)) mean += value / 100;
      }
      EXPECT_GE(held, 95) << json["title"] << " " << name_of(space);
      EXPECT_NEAR(mean, true_mean, 0.01 * true_mean) << json["title"] << " " << name_of(space);
    }
  }
}

Json stars(double radius, double emission) {
  Json scene = test::scene_with(test::json("[]"));
  scene["materials"]["star"] = {
      {"type", "lambert"}, {"reflectance", 0}, {"emission", {emission, emission, emission}}};
  test::Random random(1);
  for (int i = 0; i < 600; ++i)
    scene["objects"].push_back({{"type", "sphere"},
                                {"center", {random.between(-1.5, 1.5), random.between(-1.5, 1.5), 0}},
                                {"radius", radius},
                                {"material", "star"}});
  return scene;
}

// Some light is far brighter than the range of the display. If few samples hit it, the mean is clipped or
// dark, and both halves of the samples agree on the wrong value.
TEST(ErrorBudget, AccountsForDisplayClipping) {
  covers("certificate-19");
  Json sky = test::sample("shape-sphere");
  sky["background"] = {30, 30, 30};
  // The reference of tiny stars is an image of larger stars of equal power.
  const std::pair<Json, Json> scenes_and_truths[] = {
      {sky, sky}, {stars(0.006, 60), stars(0.006, 60)}, {stars(0.0003, 24'000), stars(0.006, 60)}};
  for (const auto& [json, true_json] : scenes_and_truths) {
    const auto scene = test::load(json);
    RenderRequest r = with_error(64, 0.05, Space::display);
    r.filter = Filter::gaussian;
    RenderRequest much = square(64);
    much.filter = r.filter;
    std::vector<double> mean(3 * 64 * 64);
    for (std::uint64_t seed = 4711; seed < 4715; ++seed) {
      much.seed = seed;
      const auto one = truth_of(test::load(true_json), much, 2048);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += one[i] / 4;
    }
    const auto truth = in_space(mean, Space::display);
    for (r.seed = 0; *r.seed < 6; ++*r.seed) {
      const RenderResult result = rendered(scene, r);
      const double realised = rms_difference(values_of(result.film, Space::display), truth);
      EXPECT_TRUE(!result.budget->met() || realised <= *r.error) << realised;
      EXPECT_LE(realised, *result.certificate.total().rms) << *result.budget->settings.samples << " samples";
    }
  }
}

// A budget is missed only after omitted contributions have been reduced. All traced rays are reported.
TEST(ErrorBudget, TracesWeakerRaysBeforeMissing) {
  const auto scene = test::load(test::sample("glass"));
  for (const double error : {0.057, 0.05, 0.045, 0.042}) {
    const RenderResult result = rendered(scene, with_error(64, error, Space::display));
    EXPECT_TRUE(result.budget->met()) << error << " " << result.budget->reason;
  }
  RenderRequest r = with_error(64, 0.06, Space::display);
  const RenderResult hopeless = rendered(test::load(test::sample("material-glass")), r);
  EXPECT_LE(*hopeless.budget->settings.samples, 1024) << "more samples would not help";
  r.on_miss = OnMiss::fail;
  EXPECT_THROW(rendered(test::load(test::sample("material-glass")), r), BudgetMissed);
}

// Between two walls of glass, reflected rays have weights of 0.02, 0.0004 and 0.000008. Some values of
// min_contribution therefore omit as much as values four times as large.
TEST(ErrorBudget, ContinuesPastGapsInRayWeights) {
  const auto scene = test::load(test::scene_of(
      "[{'type': 'plane', 'point': [0, 0, -1], 'normal': [0, 0, 1], 'material': 'wall'},"
      " {'type': 'plane', 'point': [0, 0, 6], 'normal': [0, 0, -1], 'material': 'wall'}]",
      "{'materials': {'wall': {'type': 'reflective', 'n': [1.33, 1.33, 1.33], 'k': [0, 0, 0]}},"
      " 'background': [1, 1, 1]}"));
  const RenderResult result = rendered(scene, with_error(64, 0.001, Space::linear));
  EXPECT_LT(*result.budget->settings.min_contribution, 0.0004);
  EXPECT_LE(*result.certificate.terms.front().bound.rms, 0.001 / 8);
}

// Two small mirrors face each other in a corner. The light that they omit must be traced, or the budget must
// be missed if it cannot be traced.
TEST(ErrorBudget, DetectsOmittedLightInOneCorner) {
  covers("certificate-34");
  const auto scene = test::load(
      test::scene_of("[{'type': 'sphere', 'center': [0.32, 0.42, 0], 'radius': 0.03, 'material': 'mirror'},"
                     " {'type': 'sphere', 'center': [0.39, 0.42, 0], 'radius': 0.03, 'material': 'mirror'}]",
                     "{'materials': {'mirror': {'type': 'reflective', 'n': [1, 1, 1], 'k': [9, 9, 9]}},"
                     " 'background': [1, 1, 1]}"));
  RenderRequest r = with_error(128, 0.004, Space::linear);
  r.max_depth = 1;
  r.min_contribution = 0;
  r.samples = 2;
  const RenderResult cut = rendered(scene, r);
  const auto& left_out = cut.certificate.terms.front();
  EXPECT_GT(left_out.bound.max.value(), 0.1) << "large for some pixels";
  EXPECT_LT(left_out.bound.rms.value(), 0.02) << "small on average";
  EXPECT_FALSE(cut.budget->error_met);
  r.max_depth.reset();
  const RenderResult whole = rendered(scene, r);
  EXPECT_LT(whole.certificate.terms.front().bound.rms.value_or(0), left_out.bound.rms.value() / 4);
}

// Eight overlapping glass balls have 16 surfaces, each reflecting about 4 % of the light. Each reflected ray
// is below min_contribution and omitted. The bound must add them up.
TEST(ErrorBudget, CountsManyWeakRays) {
  covers("certificate-5");
  Json sheets = Json::array();
  for (int i = 0; i < 8; ++i)
    sheets.push_back(
        {{"type", "sphere"}, {"center", {0, 0, -0.3 * i}}, {"radius", 0.9}, {"material", "half"}});
  const auto scene = test::load(test::scene_with(
      sheets,
      test::json("{'materials': {'half': {'type': 'refractive', 'ior': 1.5}}, 'background': [1, 1, 1]}")));
  RenderRequest r = with_error(64, 0.002, Space::linear);
  r.min_contribution = 1.0 / 16;
  const RenderResult result = rendered(scene, r);
  ASSERT_GT(result.stats.counts.cut_rays, 0u);
  EXPECT_GT(result.certificate.terms.front().bound.max.value(), 1.0 / 16) << "more than one omitted ray";
  EXPECT_FALSE(result.budget->error_met);
}

TEST(ErrorBudget, TerminatesForPathTracedImageOfOneTile) {
  const auto scene = test::load(test::sample("cornell-box"));
  EXPECT_LE(*rendered(scene, with_error(32, 0.5, Space::linear)).budget->settings.samples, 16);
}

TEST(ErrorBudget, RejectsJpeg) {
  RenderRequest r = with_error(32, 0.1, Space::automatic);
  EXPECT_THROW(choose_space(r, FileFormat::jpeg), InputError);
  choose_space(r, FileFormat::png);
  EXPECT_EQ(r.space, Space::display);
}

TEST(ErrorBudget, KeepsRequestedSettings) {
  covers("certificate-36");
  const auto scene = test::load(test::sample("paper"));
  RenderRequest r = with_error(64, 0.001, Space::display);
  r.samples = 4;
  const RenderResult four = rendered(scene, r);
  EXPECT_EQ(four.budget->settings.samples, 4);
  EXPECT_FALSE(four.budget->met());
  r.error = 0.9;
  EXPECT_EQ(rendered(scene, r).budget->settings.samples, 4) << "not fewer samples either";
  r.samples.reset();
  r.max_depth = 1;
  r.precision = Precision::single_precision;
  const RenderResult single = rendered(scene, r);
  EXPECT_EQ(single.budget->settings.max_depth, 1);
  EXPECT_FALSE(single.budget->met()) << "errors of float have no bound";
  EXPECT_NE(single.budget->reason.find("precision"), std::string::npos) << single.budget->reason;
}

TEST(ErrorBudget, ReportsUnprovableError) {
  covers("certificate-16 certificate-35");
  const auto scene = test::load(test::sample("paper"));
  RenderRequest r = with_error(64, 0.0005, Space::display);
  EXPECT_NE(rendered(scene, r).budget->reason.find("errors other than sampling noise may reach 0.001"),
            std::string::npos)
      << rendered(scene, r).budget->reason;
  r.error = 0.004;  // below the provable error of 64 x 64 pixels
  EXPECT_NE(rendered(scene, r).budget->reason.find("smallest provable error at this size: "),
            std::string::npos)
      << rendered(scene, r).budget->reason;
  r.on_miss = OnMiss::fail;
  EXPECT_THROW(rendered(scene, r), BudgetMissed);
  r.error = 0.2;
  EXPECT_NO_THROW(rendered(scene, r));
}

TEST(ErrorBudget, StopsAtRayLimit) {
  const auto scene = test::load(test::sample("cornell-box"));
  const RenderResult result = rendered(scene, with_error(64, 0.03, Space::display), {.max_rays = 3e5});
  EXPECT_FALSE(result.budget->met());
  EXPECT_LE(static_cast<double>(result.stats.counts.rays.total()), 3e5);
  EXPECT_NE(result.budget->reason.find("(limit "), std::string::npos) << result.budget->reason;
}

// Expects the resulting settings to reproduce the image.
void expect_repeated(const std::shared_ptr<const Scene>& scene, const RenderResult& result) {
  RenderRequest plain;
  static_cast<RenderSettings&>(plain) = result.budget->settings;
  EXPECT_FALSE(has_budget(plain));
  EXPECT_EQ(values_of(rendered(scene, plain).film, Space::linear), values_of(result.film, Space::linear));
}

TEST(ErrorBudget, IsReproducedByReportedSettings) {
  for (const char* name : {"glass", "cornell-box"}) {
    const auto scene = test::load(test::sample(name));
    expect_repeated(scene, rendered(scene, with_error(64, 0.05, Space::display)));
  }
}

// Clock that each tile advances. Tiles of the first two passes have the same mean cost. In each later pass, a
// tile costs twice as much as in the previous pass. Costs vary by 30 %, and some tiles stall.
struct FakeClock {
  double now_s = 0, tile_s = 0.001;
  double share_of_stalls = 0;
  int tiles = 0;
  test::Random random{1};
  std::mutex mutex;

  RenderControl control() {
    return {.progress =
                [this](int, int total) {
                  const std::lock_guard lock(mutex);
                  const int pass = tiles / total;
                  const double cost = tile_s * std::exp2(std::max(0, pass - 1));
                  now_s += cost * random.between(0.7, 1.3) * (random.unit() < share_of_stalls ? 5 : 1);
                  ++tiles;
                },
            .used_s =
                [this] {
                  const std::lock_guard lock(mutex);
                  return now_s;
                }};
  }
};

TEST(TimeBudget, EndsInTimeWithWholePasses) {
  covers("certificate-30");
  const auto scene = test::load(test::sample("paper"));
  int in_time = 0;
  for (int run = 0; run < 100; ++run) {
    FakeClock clock;
    clock.random = test::Random(static_cast<std::uint64_t>(run));
    clock.share_of_stalls = run % 3 == 0 ? 0.1 : 0;
    RenderRequest r = square(96);  // 9 tiles
    r.seconds = 0.1 + 0.01 * run;
    const RenderResult result = rendered(scene, r, clock.control());
    const double tile_s = 1.3 * clock.tile_s * *result.budget->settings.samples / 2;
    EXPECT_LE(clock.now_s, *r.seconds + 2 * 5 * tile_s) << "two concurrent tiles, one of them stalled";
    EXPECT_EQ(result.budget->seconds_met, result.budget->used_s <= *r.seconds);
    in_time += result.budget->seconds_met;
    if (run % 3 == 0) expect_repeated(scene, result);  // runs with stalled tiles
  }
  EXPECT_GE(in_time, 80) << "the other renders stall in their last tile";
}

// The requested sample count is not a power of two. The last pass at least doubles the samples.
TEST(TimeBudget, ReportsErrorOfRenderedSamples) {
  const auto scene = test::load(test::sample("cornell-box"));
  RenderRequest r = square(40);  // 4 tiles
  r.samples = 100;
  r.error = 1e-6;
  EXPECT_EQ(rendered(scene, r).stats.error.samples, 100);
  r.error = 0;
  int partial = 0;
  for (int run = 0; run < 40; ++run) {
    FakeClock clock;
    clock.random = test::Random(static_cast<std::uint64_t>(run));
    clock.share_of_stalls = 0.1;
    r.seconds = 0.004 * (run + 2);
    const RenderResult result = rendered(scene, r, clock.control());
    const int samples = *result.budget->settings.samples;
    EXPECT_EQ(result.stats.error.samples, samples == 1 ? 0 : samples) << run;
    partial += samples < 100 && samples > 1;
  }
  EXPECT_GE(partial, 10);
}

TEST(TimeBudget, ReportsSlowFirstPass) {
  FakeClock clock;
  RenderRequest r = square(96);
  r.seconds = 0.002;
  const RenderResult result = rendered(test::load(test::sample("paper")), r, clock.control());
  EXPECT_FALSE(result.budget->seconds_met);
  EXPECT_EQ(result.budget->reason, "first pass exceeded the time limit");
  EXPECT_EQ(result.stats.counts.rays.camera, 2u * 96 * 96) << "the first pass is complete";
}

// Fails before the render if the first tiles show that the budget cannot be met.
TEST(TimeBudget, FailsEarlyIfUnreachable) {
  covers("certificate-35");
  FakeClock clock;
  RenderRequest r = square(1024);  // 1024 tiles
  r.seconds = 0.5;
  r.on_miss = OnMiss::fail;
  try {
    rendered(test::load(test::sample("paper")), r, clock.control());
    FAIL() << "expected BudgetMissed";
  } catch (const BudgetMissed& missed) {
    EXPECT_FALSE(missed.outcome().seconds_met);
    EXPECT_NEAR(*missed.outcome().min_s, 1.024, 0.2);
    EXPECT_NE(std::string(missed.what()).find("first pass would take about"), std::string::npos);
    EXPECT_FALSE(missed.certificate().total().rms) << "no bound without an image";
  }
  EXPECT_LE(clock.tiles, 16 + 2) << "first 16 tiles, and those already begun by two threads";
  FakeClock slow;
  slow.tile_s = 1;
  try {
    rendered(test::load(test::sample("paper")), r, slow.control());
    FAIL() << "expected BudgetMissed";
  } catch (const BudgetMissed& missed) {
    EXPECT_FALSE(missed.outcome().seconds_met);
    EXPECT_FALSE(missed.outcome().min_s) << "too few tiles for an estimate";
  }
  FakeClock in_time;
  r.seconds = 2;
  EXPECT_TRUE(rendered(test::load(test::sample("paper")), r, in_time.control()).budget->met());
}

// If the first result omits too much light that the pilot missed, a second render traces weaker rays. If the
// second render does not end in time, the first result is the image.
TEST(TimeBudget, RestoresPreviousResult) {
  const auto scene = test::load(
      test::scene_of("[{'type': 'sphere', 'center': [0.32, 0.42, 0], 'radius': 0.02, 'material': 'mirror'},"
                     " {'type': 'sphere', 'center': [0.365, 0.42, 0], 'radius': 0.02, 'material': 'mirror'}]",
                     "{'materials': {'mirror': {'type': 'reflective', 'n': [1, 1, 1], 'k': [1.3, 1.3, 1.3]}},"
                     " 'background': [1, 1, 1]}"));
  const RenderRequest r = with_error(256, 0.0002, Space::linear);
  FakeClock clock;
  RenderControl control = clock.control();
  control.max_s = 0.1;  // a pass takes 0.064
  const RenderResult late = rendered(scene, r, control);
  EXPECT_LT(clock.now_s, 0.1);
  EXPECT_GT(clock.tiles, 64) << "the second render began";
  EXPECT_EQ(late.budget->settings.samples, 2);
  EXPECT_EQ(late.stats.error.samples, 2);
  expect_repeated(scene, late);
  const RenderResult whole = rendered(scene, r);
  EXPECT_LT(*whole.budget->settings.min_contribution, *late.budget->settings.min_contribution);
}

// With both budgets, the render ends when it meets the first one.
TEST(TimeBudget, EndsAtFirstMetBudget) {
  const auto scene = test::load(test::sample("paper"));
  RenderRequest r = with_error(96, 0.5, Space::display);
  r.seconds = 1000;
  FakeClock quick;
  EXPECT_TRUE(rendered(scene, r, quick.control()).budget->met());
  EXPECT_LT(quick.now_s, 0.1);
  r.error = 0.01;
  r.seconds = 0.03;
  FakeClock clock;
  const RenderResult late = rendered(scene, r, clock.control());
  EXPECT_TRUE(late.budget->seconds_met);
  EXPECT_FALSE(late.budget->error_met);
}

}  // namespace
}  // namespace orrery
