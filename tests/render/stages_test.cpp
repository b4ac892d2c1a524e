#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/plan/plan.h"
#include "core/prepare/occlusion_samples.h"
#include "core/prepare/staged_world.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/scenes.h"
#include "tests/support/stopped.h"

// Tests occluder prediction in renders, and the training samples of the network.
namespace orrery::test {
namespace {

// Returns two balls between the sun and a floor that extends to the horizon.
Json balls_over_a_floor() {
  return scene_of(
      R"([{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0]},
          {'type': 'sphere', 'center': [-1, 0.5, 0], 'radius': 0.8},
          {'type': 'sphere', 'center': [1, 0.5, 0], 'radius': 0.8}])",
      "{'lights': [{'type': 'directional', 'direction_to_light': [0, 1, 0]}], 'camera': {'eye': [0, 2, 6]}}");
}

RenderRequest asking(Prediction prediction) {
  RenderRequest request = size(256, 256);
  request.prediction = prediction;
  request.accelerator = "bvh";
  return request;
}

template <class T>
std::vector<OcclusionSample> samples_of(const Json& json, const RenderRequest& request) {
  const PreparedScene scene(load(json));
  const Plan plan = make_plan(scene.scene(), request);
  double build_ms = 0;
  return sample_occlusion(world_for<T>(scene.parts(), *plan.accelerator, plan.time, build_ms), plan);
}

TEST(OcclusionSamples, RecordsShadowRaysWithOccluders) {
  const Json json = balls_over_a_floor();
  const auto samples = samples_of<double>(json, size(256, 256));
  int met = 0;
  for (const OcclusionSample& sample : samples) {
    EXPECT_EQ(sample.ray.direction, Vec3d(0, 1, 0));
    if (sample.occluder == kNoPrimitive) continue;
    ++met;
    const auto& at = sample.ray.origin;
    EXPECT_LT((std::abs(at.x) - 1) * (std::abs(at.x) - 1) + at.z * at.z, 0.8 * 0.8);
  }
  EXPECT_GT(met, 10);
  EXPECT_GT(static_cast<int>(samples.size()), met);
}

TEST(OcclusionSamples, LimitsSampleCount) {
  Json json = sample("glass");
  for (int i = 0; i < 40; ++i) json["lights"].push_back({{"type", "point"}, {"position", {0.1 * i, 5, 3}}});
  const auto samples = samples_of<float>(json, size(512, 512));
  EXPECT_LE(samples.size(), 16'384u);
  EXPECT_GE(samples.size(), 8'192u);
}

// For a floor seen from above, the upper and lower half of the image give equal numbers of samples. Half of
// the samples kept early are dropped later, which must not favour one half of the image.
TEST(OcclusionSamples, CoversImageEvenly) {
  const Json floor = scene_of(
      R"([{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]},
          {'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.01}])",
      R"({'lights': [{'type': 'directional', 'direction_to_light': [0, 1, 0]}],
          'camera': {'type': 'orthographic', 'eye': [0, 9, 0], 'look_at': [0, 0, 0], 'up': [0, 0, -1], 'height': 2}})");
  const auto samples = samples_of<float>(floor, size(512, 512));
  EXPECT_GT(samples.size(), 8'192u);
  const auto lower = std::count_if(samples.begin(), samples.end(),
                                   [](const OcclusionSample& sample) { return sample.ray.origin.z > 0; });
  EXPECT_NEAR(static_cast<double>(lower) / static_cast<double>(samples.size()), 0.5, 0.05);
}

TEST(OcclusionSamples, StopsOnCancellation) {
  const PreparedScene scene(load(sample("glass")));
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), asking(Prediction::network)));
  double build_ms = 0;
  EXPECT_THROW(staged_world<float>(scene.parts(), plan, build_ms, stopped()), Cancelled);
  EXPECT_NO_THROW(staged_world<float>(scene.parts(), plan, build_ms));
}

TEST(Stages, CountsPredictedAndVerifiedOccluders) {
  for (const Prediction prediction : {Prediction::network, Prediction::last, Prediction::random}) {
    const Picture picture = render(balls_over_a_floor(), asking(prediction));
    const AcceleratorCounts& counts = picture.stats.counts.accelerator;
    SCOPED_TRACE(name_of(prediction));
    EXPECT_GT(counts.verified_occluders, 0u);
    EXPECT_GT(counts.predicted_occluders, counts.verified_occluders);
  }
  EXPECT_EQ(
      render(balls_over_a_floor(), asking(Prediction::none)).stats.counts.accelerator.predicted_occluders,
      0u);
}

TEST(Stages, VerifiesMorePredictionsOfNetworkThanRandom) {
  const auto share = [](Prediction prediction) {
    const AcceleratorCounts counts = render(sample("paper"), asking(prediction)).stats.counts.accelerator;
    return static_cast<double>(counts.verified_occluders) / static_cast<double>(counts.predicted_occluders);
  };
  EXPECT_GT(share(Prediction::network), 1.5 * share(Prediction::random));
}

// Training samples, network and counts are the same for any number of threads.
TEST(Stages, CountsDeterministically) {
  for (const Prediction prediction : {Prediction::network, Prediction::last, Prediction::random}) {
    const auto counts = [&](int threads) {
      return render(sample("paper"), asking(prediction), threads).stats.counts.accelerator;
    };
    EXPECT_EQ(counts(1).verified_occluders, counts(2).verified_occluders);
    EXPECT_EQ(counts(1).predicted_occluders, counts(3).predicted_occluders);
  }
}

TEST(Stages, TrainsNetworkOncePerScene) {
  const PreparedScene scene(load(sample("paper")));
  const SettledPlan plan = settle(scene, make_plan(scene.scene(), asking(Prediction::network)));
  double first_ms = 0, second_ms = 0;
  staged_world<float>(scene.parts(), plan, first_ms);
  staged_world<float>(scene.parts(), plan, second_ms);
  EXPECT_GT(first_ms, 0);
  EXPECT_EQ(second_ms, 0);
}

}  // namespace
}  // namespace orrery::test
