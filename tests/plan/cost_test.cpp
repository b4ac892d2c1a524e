#include "core/plan/cost.h"

#include <gtest/gtest.h>

#include "core/plan/plan.h"
#include "tests/support/exhaustive.h"
#include "tests/support/pictures.h"

// Compares ray estimates with hand-computed sums of the branching process and with counts of traced rays.
namespace orrery::test {
namespace {

constexpr const char* kMaterials = R"('materials': {
  'mirror': {'type': 'reflective', 'n': [0.1, 0.1, 0.1], 'k': [4, 3, 2]},
  'glass': {'type': 'refractive', 'ior': 1.5}, 'plaster': {'type': 'rough', 'kd': [0.5, 0.5, 0.5]}})";

// Returns two balls of the material and `lights` lights.
std::shared_ptr<const Scene> balls(const std::string& material, int lights) {
  const std::string of = ", 'material': '" + material + "'}";
  Json scene = scene_of("[{'type': 'sphere', 'center': [1, 0, 0], 'radius': 0.5" + of +
                            ", {'type': 'sphere', 'center': [-1, 0, 0], 'radius': 0.5" + of + "]",
                        "{" + std::string(kMaterials) + "}");
  scene["lights"] = Json::array();
  for (int i = 0; i < lights; ++i)
    scene["lights"].push_back({{"type", "directional"}, {"direction_to_light", {1, 2, i}}});
  return load(scene);
}

RenderRequest deep(int max_depth) {
  RenderRequest request = size(8, 4);
  request.samples = 2;
  request.max_depth = max_depth;
  return request;
}

// Returns the estimated number of rays per camera ray.
double expected(const std::shared_ptr<const Scene>& scene, const RenderRequest& request) {
  return expected_rays(*scene, make_plan(*scene, request)) / (8 * 4 * 2);
}

TEST(Cost, CountsCameraAndShadowRaysForRoughSurfaces) {
  EXPECT_EQ(expected(balls("plaster", 0), deep(5)), 1);
  EXPECT_EQ(expected(balls("plaster", 1), deep(5)), 2);
  EXPECT_EQ(expected(balls("plaster", 3), deep(5)), 4);
}

TEST(Cost, GrowsWithPrimitivesTestedPerRay) {
  Json many = scene_of("[]");
  for (int i = 0; i < 1000; ++i)
    many["objects"].push_back(
        {{"type", "sphere"}, {"center", {i, 0, 0}}, {"radius", 0.4}, {"material", "white"}});
  const auto weight = [scene = load(many)](const char* accelerator) {
    RenderRequest request = size(8, 4);
    request.accelerator = accelerator;
    return ray_weight(*scene, make_plan(*scene, request));
  };
  EXPECT_EQ(weight("auto"), 1);
  EXPECT_EQ(weight("bvh"), 1);
  EXPECT_EQ(weight("kd-sah"), 1);
  EXPECT_EQ(weight("list"), 1000 * 0.5 / 20);
  EXPECT_EQ(weight("boxes"), 1000 * 0.25 / 20);
  EXPECT_EQ(weight("oriented-boxes"), 1000 * 2.8 / 20);
}

TEST(Cost, GrowsWithPixelsAndSamples) {
  const auto scene = balls("glass", 1);
  RenderRequest large = deep(5);
  large.width = 80;
  large.samples = 6;
  EXPECT_EQ(expected(scene, large), 30 * expected(scene, deep(5)));
}

TEST(Cost, AddsOneRayPerLevelForMirrors) {
  EXPECT_EQ(expected(balls("mirror", 0), deep(0)), 1);
  EXPECT_EQ(expected(balls("mirror", 0), deep(3)), 1 + 0.5 + 0.25 + 0.125);
}

TEST(Cost, AddsTwoRaysPerLevelForGlass) {
  EXPECT_EQ(expected(balls("glass", 0), deep(3)), 1 + 2 * 0.5 + 4 * 0.25 + 8 * 0.125);
  EXPECT_EQ(expected(balls("glass", 0), deep(12)), 13);
}

TEST(Cost, LimitsGlassByMinContribution) {
  RenderRequest request = deep(4);
  request.min_contribution = 0.25;  // at most four rays of a level can have this weight
  EXPECT_EQ(expected(balls("glass", 0), request), 1 + 2 * 0.5 + 4 * 0.25 + 4 * 0.125 + 4 * 0.0625);
}

// A time budget may end a render before its sample count. The estimate for an error budget assumes all
// samples.
TEST(Cost, AssumesFewerSamplesForTimeBudgets) {
  RenderRequest request = deep(0);
  request.samples = 4096;
  request.error = 0.01;
  EXPECT_EQ(expected(balls("glass", 0), request), 4096 / 2);
  request.seconds = 1;
  EXPECT_LT(expected(balls("glass", 0), request), 4096 / 2);
}

TEST(Cost, IgnoresDepthWithoutSecondaryRays) {
  RenderRequest request = deep(5);
  request.technique = "raycast";
  EXPECT_EQ(expected(balls("glass", 0), request), 1);
}

TEST(Cost, CountsShadowRaysOnlyForDiffuseSurfaces) {
  Json scene = scene_of(
      "[{'type': 'sphere', 'center': [1, 0, 0], 'radius': 0.5, 'material': 'mirror'},"
      " {'type': 'sphere', 'center': [-1, 0, 0], 'radius': 0.5, 'material': 'plaster'}]",
      "{" + std::string(kMaterials) +
          ", 'lights': [{'type': 'directional', 'direction_to_light': [0, 1, 0]}]}");
  EXPECT_EQ(expected(load(scene), deep(2)), 1.75 * 1.5);
}

TEST(Cost, EndsDistributedRaysAtDiffuseSurfaces) {
  RenderRequest request = deep(3);
  request.technique = "distributed";
  EXPECT_EQ(expected(balls("plaster", 1), request), 1 + 2 + 1) << "one shadow ray";
  const double mirrors = 1 + 2 + 1.7 * (1 + 0.7 + 0.49);
  EXPECT_NEAR(expected(balls("mirror", 1), request), mirrors, 1e-12);
  request.technique = "path";
  request.reuse = 1;
  EXPECT_NEAR(expected(balls("plaster", 1), request), mirrors, 1e-12);
}

class SampleSceneCost : public testing::TestWithParam<std::string> {};

TEST_P(SampleSceneCost, IsWithinOrderOfMagnitudeOfTracedRays) {
  const auto scene = load(sample(GetParam()));
  RenderRequest request = size(160, 120);
  if (reduced()) request.samples = 2;
  const double traced = static_cast<double>(render(scene, request).stats.counts.rays.total());
  const double share = expected_rays(*scene, make_plan(*scene, request)) / traced;
  RecordProperty("expected_over_traced", std::to_string(share));
  EXPECT_GT(share, 0.4);
  EXPECT_LT(share, 6.5);
}

INSTANTIATE_TEST_SUITE_P(Samples, SampleSceneCost, testing::ValuesIn(sample_names()));

}  // namespace
}  // namespace orrery::test
