// Compares forecasts of renders with the renders.
#include <gtest/gtest.h>

#include <cmath>

#include "core/budget/budget.h"
#include "tests/support/pictures.h"

namespace orrery {
namespace {

using test::load;
using test::sample;

constexpr int kSide = 192;

RenderRequest square() {
  RenderRequest r;
  r.width = r.height = kSide;
  return r;
}

Forecast extrapolated(const std::shared_ptr<const Scene>& scene, const RenderRequest& request,
                      Executor& executor = test::shared_executor(), const RenderControl& control = {}) {
  const PreparedScene prepared(scene);
  return forecast(prepared, settle(prepared, make_plan(*scene, request)), executor, control);
}

// Each pass doubles the samples, so a forecast may differ by one pass. Ray counts are compared per sample.
TEST(Forecast, PredictsSamplesAndRaysOfErrorBudget) {
  for (const char* name : {"paper", "glass", "cornell-box", "sphereflake-2"})
    for (const double error : {0.05, 0.02}) {
      const auto scene = load(sample(name));
      RenderRequest r = square();
      r.error = error;
      r.space = Space::display;
      const Forecast told = extrapolated(scene, r);
      const RenderResult made = test::rendered(scene, r);
      const int samples = *told.outcome.settings.samples, taken = *made.budget->settings.samples;
      EXPECT_LE(std::max(samples, taken), 2 * std::min(samples, taken)) << name << error;
      const double rays = told.rays / samples, traced = double(made.stats.counts.rays.total()) / taken;
      EXPECT_NEAR(rays / traced, 1, 0.25) << name << error;
      EXPECT_TRUE(told.outcome.error_met) << name << error;
      EXPECT_LE(*told.certificate.total().rms, error) << name << error;
      EXPECT_GT(told.seconds, 0);
    }
}

TEST(Forecast, PredictsRaysAndErrorOfFixedSamples) {
  for (const char* name : {"glass", "cornell-box"}) {
    const auto scene = load(sample(name));
    RenderRequest r = square();
    r.precision = Precision::double_precision;
    r.samples = 6;
    const Forecast told = extrapolated(scene, r);
    const RenderResult made = test::rendered(scene, r);
    EXPECT_EQ(told.outcome.settings.samples, 6);
    EXPECT_NEAR(told.rays / static_cast<double>(made.stats.counts.rays.total()), 1, 0.15) << name;
    EXPECT_NEAR(*told.certificate.estimate / *made.certificate.estimate, 1, 0.4) << name;
    r.samples = 1;
    const Forecast single = extrapolated(scene, r);
    const RenderResult one = test::rendered(scene, r);
    EXPECT_NEAR(single.rays / static_cast<double>(one.stats.counts.rays.total()), 1, 0.15) << name;
    EXPECT_TRUE(std::isfinite(single.seconds)) << name;
    EXPECT_FALSE(single.certificate.estimate) << "one sample gives no error estimate";
  }
}

// Each pass doubles the samples, so the forecast uses more than half of the time budget unless the sample
// count reaches its maximum. The clock of the test does not advance.
TEST(Forecast, FillsTimeBudget) {
  const auto scene = load(sample("cornell-box"));
  RenderRequest r = square();
  r.seconds = 100;
  const Forecast told = extrapolated(scene, r, test::shared_executor(), {.used_s = [] { return 0.0; }});
  EXPECT_LE(told.outcome.used_s, 100);
  EXPECT_TRUE(told.outcome.used_s > 50 || told.outcome.settings.samples == 4096) << told.outcome.used_s;
  EXPECT_TRUE(told.outcome.met());
}

TEST(Forecast, DependsOnPlanOnly) {
  ThreadExecutor one(1);
  for (const char* name : {"glass", "cornell-box"}) {
    const auto scene = load(sample(name));
    RenderRequest r = square();
    r.error = 0.03;
    const Forecast a = extrapolated(scene, r), b = extrapolated(scene, r, one);
    EXPECT_EQ(a.outcome.settings.samples, b.outcome.settings.samples) << name;
    EXPECT_EQ(a.rays, b.rays) << name;
    EXPECT_EQ(a.certificate.total().rms, b.certificate.total().rms) << name;
  }
}

// With a fixed sample count, limits on rays and time do not apply. The service rejects such requests.
TEST(Forecast, IgnoresLimitsForFixedSamples) {
  RenderRequest r = square();
  r.samples = 4096;
  const Forecast told =
      extrapolated(load(sample("paper")), r, test::shared_executor(), {.max_rays = 10, .max_s = 1e-3});
  EXPECT_EQ(told.outcome.settings.samples, 4096);
}

// The three omitted rays of this image are outside of the pilot's blocks, but in its tiles.
TEST(Forecast, ReportsOmissionsSeenOnlyInTiles) {
  const auto scene = load(sample("orrery"));
  RenderRequest r = test::size(128, 128);
  r.samples = 4;
  r.max_depth = 8;
  ASSERT_EQ(test::rendered(scene, r).stats.counts.cut_rays, 3u);
  const Bound bound = extrapolated(scene, r).certificate.terms.front().bound;
  EXPECT_EQ(bound.kind, Bound::Kind::estimated);
  EXPECT_GT(*bound.rms, 0);
}

TEST(Forecast, PredictsMissedBudget) {
  RenderRequest r = square();
  r.error = 1e-6;
  r.on_miss = OnMiss::fail;
  const BudgetOutcome told = extrapolated(load(sample("paper")), r).outcome;
  EXPECT_FALSE(told.met());
  EXPECT_NE(told.reason.find("smallest provable error"), std::string::npos) << told.reason;
  EXPECT_GT(*told.min_error, 1e-6);
}

// Covers images that the pilot renders completely, and images smaller than a block.
TEST(Forecast, SupportsSmallestImages) {
  for (const int side : {1, 3, 33}) {
    RenderRequest r = square();
    r.width = r.height = side;
    r.error = 0.05;
    r.technique = "path";
    const Forecast told = extrapolated(load(sample("cornell-box")), r);
    EXPECT_GT(told.rays, side * side) << side;
    EXPECT_TRUE(std::isfinite(told.seconds)) << side;
  }
}

TEST(Forecast, StopsOnCancellation) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
      extrapolated(load(sample("paper")), square(), test::shared_executor(), {.stop = stop.get_token()}),
      Cancelled);
}

}  // namespace
}  // namespace orrery
