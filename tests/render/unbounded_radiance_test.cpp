// Tests bounds and error budgets of images whose radiance has no upper limit: path tracing in linear
// radiance.
#include <gtest/gtest.h>

#include <cmath>
#include <mutex>

#include "core/budget/budget.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

RenderRequest paths(int side) {
  RenderRequest r = size(side, side);
  r.technique = "path";
  r.space = Space::linear;
  r.precision = Precision::double_precision;
  return r;
}

std::vector<double> reference(const std::shared_ptr<const Scene>& scene, RenderRequest r) {
  r.samples = 512;
  r.seed = 4711;
  r.max_depth = 32;
  r.error.reset();
  return linear_values(rendered(scene, r).film);
}

// The bound is wrong for at most 5 of 100 seeds on average, and for more than 10 of 100 with a probability of
// 1 %. The references have an 11th of the error.
TEST(UnboundedRadiance, BoundHoldsOverSeeds) {
  covers("certificate-17");
  for (const char* name : {"cornell-box", "material-metal", "outdoors"}) {
    const auto scene = load(sample(name));
    RenderRequest r = paths(64);
    r.max_depth = 32;
    const std::vector<double> truth = reference(scene, r);
    for (const int reuse : {1, 16}) {
      int wrong = 0;
      double slack = 0;
      r.reuse = reuse;
      r.samples = 4;
      for (r.seed = 0; *r.seed < 100; ++*r.seed) {
        const RenderResult result = rendered(scene, r);
        const Bound bound = result.certificate.total();
        ASSERT_EQ(bound.kind, Bound::Kind::estimated) << name;
        EXPECT_FALSE(bound.max) << "no largest error is known";
        const double error = rms_difference(linear_values(result.film), truth);
        wrong += *bound.rms < error;
        slack += *bound.rms / error / 100;
      }
      std::printf("%s, reuse %d: %d of 100 bounds too small, mean bound / error %.2f\n", name, reuse, wrong,
                  slack);
      EXPECT_LE(wrong, 10) << name << " " << reuse;
      EXPECT_LE(slack, 4) << name << " " << reuse;
    }
  }
}

// The errors per block are skewed: one block in fifty errs. The bound of the mean square holds for at least
// 95 % of the images.
TEST(UnboundedRadiance, BoundHoldsForRareErrors) {
  Random random(3);
  constexpr int kBlocks = 1024, kImages = 2000;
  constexpr double kShare = 0.02, kLight = 9;
  int held = 0;
  for (int image = 0; image < kImages; ++image) {
    SampledError error;
    for (int block = 0; block < kBlocks; ++block) {
      const double sum = random.unit() < kShare ? kLight * random.unit() : 0.1 * random.unit();
      error.pixel.squares += sum;
      error.pixel.values += 48;
      error.blocks += 1;
      error.block_sum += sum;
      error.block_squares += sum * sum;
    }
    const double expected = (kShare * kLight / 2 + (1 - kShare) * 0.05) / 48;
    held += std::pow(error.upper_rmse(0.05, false), 2) >= expected;
  }
  EXPECT_GE(held, 0.935 * kImages);
  EXPECT_LE(held, 0.99 * kImages) << "a much larger bound would always hold";
}

TEST(UnboundedRadiance, NeedsErrorsOfFourIndependentParts) {
  const auto box = load(sample("cornell-box"));
  RenderRequest r = paths(32);  // one tile
  r.samples = 4;
  r.reuse = 16;
  EXPECT_EQ(rendered(box, r).certificate.total().kind, Bound::Kind::unknown) << "paths of a tile are reused";
  r.reuse = 1;
  EXPECT_EQ(rendered(box, r).certificate.total().kind, Bound::Kind::estimated);
  r.samples = 3;
  EXPECT_EQ(rendered(box, r).certificate.total().kind, Bound::Kind::unknown) << "no halves";
  r = paths(64);
  r.samples = 4;
  const auto dark =
      load(scene_of("{'type': 'sphere', 'center': [0, 0, 99], 'radius': 1}", "{'background': [2, 2, 2]}"));
  EXPECT_EQ(rendered(dark, r).certificate.total().kind, Bound::Kind::unknown)
      << "a bound of 0 proves nothing";
}

// Bounds that need a range of radiance keep their kind: light that a mirror may amplify has no bound.
TEST(UnboundedRadiance, KeepsUnknownTerms) {
  RenderRequest r = paths(64);
  r.samples = 4;
  r.max_depth = 2;
  const auto endless = load(
      scene_of("[{'type': 'box', 'min': [-2, -2, -2], 'max': [2, 2, 2], 'material': 'wall'},"
               " {'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.5, 'material': 'lamp'}]",
               "{'materials': {'wall': {'type': 'lambert', 'reflectance': 0.9},"
               " 'lamp': {'type': 'lambert', 'reflectance': 1, 'emission': [3, 2, 1]}}, 'camera': {'type':"
               " 'perspective', 'eye': [0, 0, 1.9], 'look_at': [0, 0, 0], 'fov_degrees': 60}}"));
  EXPECT_EQ(rendered(endless, r).certificate.total().kind, Bound::Kind::unknown);
}

TEST(UnboundedRadiance, ErrorBudgetIsMetByEstimatedBound) {
  const auto box = load(sample("cornell-box"));
  RenderRequest r = paths(96);
  const std::vector<double> truth = reference(box, r);
  r.on_miss = OnMiss::fail;
  int before = 0;
  for (const double error : {0.2, 0.05, 0.02}) {
    r.error = error;
    const RenderResult result = rendered(box, r);
    ASSERT_TRUE(result.budget);
    EXPECT_TRUE(result.budget->met()) << error << " " << result.budget->reason;
    EXPECT_EQ(result.budget->kind, Bound::Kind::estimated);
    EXPECT_EQ(result.certificate.total().kind, Bound::Kind::estimated);
    EXPECT_FALSE(result.budget->min_error) << "no error is provable";
    EXPECT_LE(*result.certificate.total().rms, error);
    EXPECT_LE(rms_difference(linear_values(result.film), truth), error);
    EXPECT_GE(*result.budget->settings.samples, before);
    before = *result.budget->settings.samples;
  }
  EXPECT_GT(before, 2);
}

// A limit that the largest number of samples misses.
TEST(UnboundedRadiance, MissedErrorBudgetReportsBound) {
  const auto box = load(sample("cornell-box"));
  RenderRequest r = paths(64);
  r.error = 1e-3;
  r.samples = 16;
  const RenderResult result = rendered(box, r);
  EXPECT_FALSE(result.budget->met());
  EXPECT_EQ(result.budget->reason, "sample limit reached");
  EXPECT_EQ(result.budget->kind, Bound::Kind::estimated);
  EXPECT_GT(*result.certificate.total().rms, 1e-3);
  r.max_depth = 1;
  r.samples.reset();
  r.on_miss = OnMiss::fail;
  EXPECT_THROW(rendered(box, r), BudgetMissed) << "light of longer paths is missing";
}

TEST(UnboundedRadiance, TimeBudgetReportsEstimatedBound) {
  const auto box = load(sample("cornell-box"));
  RenderRequest r = paths(96);
  r.seconds = 0.1;
  double now_s = 0;
  std::mutex mutex;
  const RenderResult result = rendered(box, r,
                                       {.progress =
                                            [&](int, int) {
                                              const std::lock_guard lock(mutex);
                                              now_s += 0.001;  // a pass of 9 tiles takes 0.009 seconds
                                            },
                                        .used_s =
                                            [&] {
                                              const std::lock_guard lock(mutex);
                                              return now_s;
                                            }});
  EXPECT_TRUE(result.budget->met());
  EXPECT_GT(*result.budget->settings.samples, 4);
  EXPECT_EQ(result.certificate.total().kind, Bound::Kind::estimated);
  EXPECT_GT(*result.certificate.total().rms, *result.certificate.estimate);
}

}  // namespace
}  // namespace orrery::test
