#include "server/scheduler/ray_estimator.h"

#include <gtest/gtest.h>

#include "core/plan/cost.h"
#include "core/plan/plan.h"
#include "tests/support/pictures.h"

// Tests estimates of ray counts, which learn from earlier renders of the same scene.
namespace orrery {
namespace {

using test::load, test::render, test::sample, test::size;

std::uint64_t traced(const std::shared_ptr<const Scene>& scene, const RenderRequest& request) {
  return render(scene, request).stats.counts.rays.total();
}

RenderRequest large() {
  RenderRequest request = size(320, 240);
  request.samples = 4;
  return request;
}

TEST(RayEstimator, StartsFromPlanEstimate) {
  RayEstimator estimator;
  const auto scene = load(sample("glass"));
  const Plan plan = make_plan(*scene, large());
  EXPECT_EQ(estimator.estimate(*scene, plan), expected_rays(*scene, plan));
}

class SampleRayEstimates : public testing::TestWithParam<const char*> {};

// One small preview predicts the rays of the large image within 30 %.
TEST_P(SampleRayEstimates, PredictsLargeRenderFromPreview) {
  RayEstimator estimator;
  const auto scene = load(sample(GetParam()));
  RenderRequest preview = size(80, 60);
  preview.samples = 1;
  preview.azimuth_degrees = 10;
  estimator.learn(*scene, make_plan(*scene, preview), traced(scene, preview));
  const double truth = static_cast<double>(traced(scene, large()));
  const double learned = estimator.estimate(*scene, make_plan(*scene, large())) / truth;
  RecordProperty("learned_over_traced", std::to_string(learned));
  EXPECT_GT(learned, 0.7);
  EXPECT_LT(learned, 1.3);
}

INSTANTIATE_TEST_SUITE_P(Samples, SampleRayEstimates,
                         testing::Values("glass", "light-many", "material-refractive", "mirrors", "orrery",
                                         "paper", "shape-mesh", "sphereflake-2"));

// Each observation moves the estimate halfway to the observed value.
TEST(RayEstimator, MovesHalfwayToEachObservation) {
  RayEstimator estimator;
  const auto scene = load(sample("paper"));
  const Plan plan = make_plan(*scene, size(64, 64));
  const double expected = expected_rays(*scene, plan);
  const auto after = [&](double factor) {
    estimator.learn(*scene, plan, static_cast<std::uint64_t>(factor * expected));
    return estimator.estimate(*scene, plan) / expected;
  };
  EXPECT_NEAR(after(1), 1, 1e-3);
  EXPECT_NEAR(after(2), 1.5, 1e-3);
  EXPECT_NEAR(after(0.5), 1, 1e-3);
}

// Limits the influence of a single client. A tiny image has little weight, and no image changes the estimate
// by more than a factor of 8.
TEST(RayEstimator, LimitsInfluenceOfObservations) {
  const auto scene = load(sample("paper"));
  const Plan plan = make_plan(*scene, size(64, 64)), tiny = make_plan(*scene, size(1, 1));
  const double expected = expected_rays(*scene, plan);
  for (const std::uint64_t rays : {std::uint64_t{0}, std::uint64_t{1} << 60}) {
    RayEstimator once, often;
    once.learn(*scene, tiny, rays);
    EXPECT_NEAR(once.estimate(*scene, plan) / expected, 1, 7.0 / 4096);
    for (int i = 0; i < 100; ++i) often.learn(*scene, plan, rays);
    EXPECT_NEAR(often.estimate(*scene, plan) / expected, rays == 0 ? 1.0 / 8 : 8, 1e-9);
  }
}

TEST(RayEstimator, LearnsPerSceneAndSettings) {
  RayEstimator estimator;
  const auto scene = load(sample("glass")), other = load(sample("paper"));
  const Plan plan = make_plan(*scene, large());
  estimator.learn(*scene, plan, 1);
  EXPECT_DOUBLE_EQ(estimator.estimate(*scene, plan), expected_rays(*scene, plan) / 8);
  const auto is_unknown = [&](const std::shared_ptr<const Scene>& s, const RenderRequest& request) {
    const Plan asked = make_plan(*s, request);
    return estimator.estimate(*s, asked) == expected_rays(*s, asked);
  };
  EXPECT_TRUE(is_unknown(other, large()));
  RenderRequest shallow = large(), simple = large(), coarse = large();
  shallow.max_depth = 3;
  simple.technique = "raycast";
  coarse.min_contribution = 0.1;
  EXPECT_TRUE(is_unknown(scene, shallow));
  EXPECT_TRUE(is_unknown(scene, simple));
  EXPECT_TRUE(is_unknown(scene, coarse));
  estimator.learn(*scene, make_plan(*scene, simple), 1);
  RenderRequest flat = large();  // same depth as `simple`, other technique
  flat.max_depth = 0;
  EXPECT_TRUE(is_unknown(scene, flat));
}

}  // namespace
}  // namespace orrery
