#include "core/plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/accelerators/registry.h"
#include "core/load/load.h"
#include "core/model/technique.h"
#include "core/plan/options.h"
#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests which parts of a render the plan skips, the reasons that it states, and the ray counts that confirm
// the omission.
namespace orrery::test {
namespace {

constexpr const char* kBall = "{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}";
constexpr const char* kSun = "[{'type': 'directional', 'direction_to_light': [1, 1, 1]}]";

Plan plan_of(const Json& scene, const RenderRequest& request = {}) {
  return make_plan(*load(scene), request);
}

Json scene_of_materials(std::initializer_list<const char*> materials, const char* lights = kSun) {
  Json scene = scene_of("[]", "{'materials': {'white': null}}");
  scene["lights"] = json(lights);
  int i = 0;
  for (const char* text : materials) {
    const std::string name = "m" + std::to_string(i);
    scene["materials"][name] = json(text);
    scene["objects"].push_back(
        {{"type", "sphere"}, {"center", {1.5 * i++, 0, 0}}, {"radius", 0.7}, {"material", name}});
  }
  return scene;
}
constexpr const char* kRough = "{'type': 'rough'}";
constexpr const char* kMirror = "{'type': 'reflective', 'n': [0.2, 0.2, 0.2], 'k': [3, 3, 3]}";
constexpr const char* kGlass = "{'type': 'refractive', 'ior': 1.5}";
constexpr const char* kAmber = "{'type': 'refractive', 'ior': 1.5, 'filter': [0.9, 0.5, 0.1]}";

std::uint64_t sum(const RayCounts::ByDepth& counts) {
  std::uint64_t total = 0;
  for (const std::uint64_t count : counts) total += count;
  return total;
}

bool decides(const Plan& plan, const std::string& subject) {
  return std::any_of(plan.decisions.begin(), plan.decisions.end(),
                     [&](const Decision& d) { return d.subject == subject; });
}

TEST(Plan, OmitsDirectLightWithoutEffect) {
  const Json no_light = scene_of_materials({kRough, kRough}, "[]");
  EXPECT_FALSE(plan_of(no_light).direct_light);
  const Json dark_light = scene_of_materials(
      {kRough, kRough}, "[{'type': 'directional', 'direction_to_light': [1, 1, 1], 'intensity': [0, 0, 0]}]");
  EXPECT_FALSE(plan_of(dark_light).direct_light);
  const Json all_mirrors = scene_of_materials({kMirror, kGlass});
  EXPECT_FALSE(plan_of(all_mirrors).direct_light);
  for (const Json& scene : {no_light, dark_light, all_mirrors})
    EXPECT_EQ(sum(render(scene).stats.counts.rays.shadow), 0u);
  EXPECT_GT(sum(render(scene_of_materials({kRough, kMirror})).stats.counts.rays.shadow), 0u);
}

TEST(Plan, OmitsShadowsOfSingleConvexBody) {
  Json scene = scene_of_materials({kRough});
  EXPECT_FALSE(plan_of(scene).shadows);
  EXPECT_EQ(sum(render(scene).stats.counts.rays.shadow), 0u);
  scene["camera"]["eye"] = {0, 0, 0.5};  // inside the body
  scene["camera"]["look_at"] = {0, 0, -1};
  EXPECT_TRUE(plan_of(scene).shadows);
  EXPECT_TRUE(plan_of(scene_of_materials({kRough, kRough})).shadows);
  EXPECT_FALSE(plan_of(scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]",
                                "{'lights': [{'type': 'point', 'position': [0, 0, 2]}]}"))
                   .shadows);
}

TEST(Plan, OmitsUnneededReflectedAndRefractedRays) {
  const Json rough = scene_of_materials({kRough, kRough}), metal = scene_of_materials({kRough, kMirror}),
             glass = scene_of_materials({kRough, kGlass}), amber = scene_of_materials({kRough, kAmber});
  EXPECT_FALSE(plan_of(rough).specular);
  EXPECT_EQ(plan_of(rough).max_depth, 0);
  EXPECT_EQ(render(rough).stats.counts.rays.total() - render(rough).stats.counts.rays.camera -
                sum(render(rough).stats.counts.rays.shadow),
            0u);
  EXPECT_TRUE(plan_of(metal).specular);
  EXPECT_FALSE(plan_of(metal).filters);
  EXPECT_EQ(sum(render(metal).stats.counts.rays.refracted), 0u);
  EXPECT_GT(sum(render(metal).stats.counts.rays.reflected), 0u);
  EXPECT_FALSE(plan_of(glass).filters);
  EXPECT_GT(sum(render(glass).stats.counts.rays.refracted), 0u);
  EXPECT_TRUE(plan_of(amber).filters);
}

TEST(Plan, IgnoresUnusedMaterials) {
  Json scene = scene_of_materials({kRough, kRough});
  scene["materials"]["unused"] = json(kAmber);
  EXPECT_FALSE(plan_of(scene).specular);
  EXPECT_FALSE(plan_of(scene).filters);
}

TEST(Plan, LimitsDepthForSingleMirror) {
  EXPECT_EQ(plan_of(scene_of_materials({kMirror})).max_depth, 1);
  EXPECT_EQ(plan_of(scene_of_materials({kMirror, kMirror})).max_depth, 5);
  EXPECT_EQ(plan_of(scene_of_materials({kGlass})).max_depth, 5)
      << "light in glass is refracted at least twice";
}

TEST(Plan, SendsNoSecondaryRaysForRaycast) {
  RenderRequest request;
  request.technique = "raycast";
  const Json scene = scene_of_materials({kRough, kMirror, kAmber});
  EXPECT_EQ(plan_of(scene, request).max_depth, 0);
  const RayCounts rays = render(scene, request).stats.counts.rays;
  EXPECT_EQ(sum(rays.reflected) + sum(rays.refracted), 0u);
}

TEST(Plan, ChoosesDoubleForVisibleFloatErrors) {
  covers("A18");
  const auto is_double = [](const Vec3d& at, double radius, double distance) {
    const Json ball{{"type", "sphere"}, {"center", numbers(at)}, {"radius", radius}};
    return plan_of(scene_with(ball, Json{{"camera",
                                          {{"eye", numbers(at + Vec3d(0, 0, distance))},
                                           {"look_at", numbers(at)}}}}))
        .double_precision;
  };
  EXPECT_FALSE(is_double(Vec3d(), 1, 4));
  EXPECT_FALSE(is_double(Vec3d(100, 0, 0), 1, 4));
  EXPECT_TRUE(is_double(Vec3d(1e6, 1e6, 1e6), 1, 4));
  EXPECT_TRUE(is_double(Vec3d(0, 0, 0), 1e-5, 4)) << "tiny and far from the eye";
  EXPECT_FALSE(is_double(Vec3d(0, 0, 0), 1e-5, 4e-5)) << "only ratios of lengths matter";
  RenderRequest request;
  request.precision = Precision::single_precision;
  EXPECT_FALSE(
      plan_of(scene_of("[{'type': 'sphere', 'center': [1e9, 0, 0], 'radius': 1}]"), request).double_precision)
      << "as requested";
}

TEST(Plan, ChoosesListForFewPrimitives) {
  Json objects = Json::array();
  for (int i = 0; i < 8; ++i) objects.push_back(placed(json(kBall), 0.1, Vec3d(i, 0, 0)));
  EXPECT_STREQ(plan_of(scene_with(objects)).accelerator->name, "list");
  objects.push_back(json(kBall));
  EXPECT_STRNE(plan_of(scene_with(objects)).accelerator->name, "list");
  for (const auto& type : accelerator_types()) {
    RenderRequest request;
    request.accelerator = type.name;
    EXPECT_STREQ(plan_of(scene_with(objects), request).accelerator->name, type.name) << "as requested";
  }
}

TEST(Plan, SortsRaysOnlyOnRequest) {
  Json scene = scene_of_materials({kRough, kMirror});
  RenderRequest request;
  EXPECT_FALSE(plan_of(scene).reorder);
  request.reorder = true;
  const Plan asked = plan_of(scene, request);
  EXPECT_TRUE(asked.reorder);
  EXPECT_TRUE(decides(asked, "ray order"));
  EXPECT_FALSE(decides(plan_of(scene), "ray order"));
  scene["render"] = {{"reorder", true}};
  EXPECT_TRUE(plan_of(scene).reorder);
  request.reorder = false;
  EXPECT_FALSE(plan_of(scene, request).reorder);
}

TEST(Plan, PredictsShadowsOnlyOnRequest) {
  Json scene = scene_of_materials({kRough, kMirror});
  EXPECT_EQ(plan_of(scene).prediction, Prediction::none);
  EXPECT_FALSE(decides(plan_of(scene), "shadow prediction"));
  scene["render"] = {{"prediction", "network"}};
  EXPECT_EQ(plan_of(scene).prediction, Prediction::network);
  RenderRequest request;
  request.prediction = Prediction::last;
  EXPECT_EQ(plan_of(scene, request).prediction, Prediction::last);
  EXPECT_TRUE(decides(plan_of(scene, request), "shadow prediction"));
  request.prediction = Prediction::none;
  EXPECT_EQ(plan_of(scene, request).prediction, Prediction::none);
}

TEST(Plan, EndsDistributedRaysAtDiffuseSurfaces) {
  const std::string subject = "diffuse interreflection";
  RenderRequest request;
  request.technique = "distributed";
  const auto choice = [&](const Json& scene) -> std::string {
    for (const Decision& decision : plan_of(scene, request).decisions)
      if (decision.subject == subject) return decision.choice;
    return "";
  };
  Json scene = scene_of_materials({kRough, kMirror});
  scene["camera"]["aperture_radius"] = 0.1;
  scene["camera"]["focus_distance"] = 4;
  EXPECT_EQ(choice(scene), "none");
  const char* brushed = "{'type': 'metal', 'name': 'iron', 'roughness': 0.4}";
  EXPECT_EQ(choice(scene_of_materials({kMirror, kGlass, brushed})), "") << "nothing is diffuse";
  scene["ambient"] = {0.1, 0.1, 0.1};
  EXPECT_EQ(choice(scene), "ambient light instead");
  EXPECT_FALSE(decides(plan_of(scene, request), "ambient light"));
  EXPECT_TRUE(plan_of(scene, request).lens);
  EXPECT_EQ(plan_of(scene, request).reuse, 1);
  request.technique = "path";
  EXPECT_EQ(choice(scene), "");
  EXPECT_TRUE(decides(plan_of(scene, request), "ambient light"));
  EXPECT_GT(plan_of(scene, request).reuse, 1);
}

TEST(Plan, GivesReasonForEveryDecision) {
  for (const std::string& name : sample_names())
    for (const Decision& decision : plan_of(sample(name)).decisions) {
      EXPECT_FALSE(decision.subject.empty() || decision.choice.empty() || decision.reason.empty()) << name;
    }
}

TEST(Plan, UsesSceneSettingsUnlessRequestOverridesThem) {
  Json scene = scene_of_materials({kRough, kGlass});
  scene["image"] = {{"width", 123}, {"height", 45}};
  scene["render"] = {
      {"max_depth", 7}, {"samples", 3}, {"technique", "raycast"}, {"precision", "double"}, {"seed", 99}};
  Plan plan = plan_of(scene);
  EXPECT_EQ(plan.width, 123);
  EXPECT_EQ(plan.samples, 3);
  EXPECT_EQ(plan.seed, 99u);
  EXPECT_TRUE(plan.double_precision);
  EXPECT_STREQ(plan.technique->name, "raycast");
  RenderRequest request = size(10, 20);
  request.technique = "whitted";
  request.max_depth = 2;
  plan = plan_of(scene, request);
  EXPECT_EQ(plan.width, 10);
  EXPECT_EQ(plan.max_depth, 2);
  EXPECT_EQ(plan.samples, 3);
}

// Compares the settings that, together with the scene, determine the image.
void expect_same_picture(const Plan& a, const Plan& b) {
  EXPECT_EQ(std::pair(a.width, a.height), std::pair(b.width, b.height));
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.frame.eye, b.frame.eye);
  EXPECT_EQ(a.frame.right, b.frame.right);
  EXPECT_EQ(a.frame.up, b.frame.up);
  EXPECT_EQ(a.frame.back, b.frame.back);
  EXPECT_EQ(a.frame.half_extent, b.frame.half_extent);
  EXPECT_EQ(a.technique, b.technique);
  EXPECT_EQ(a.accelerator, b.accelerator);
  EXPECT_EQ(a.double_precision, b.double_precision);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.max_depth, b.max_depth);
  EXPECT_EQ(a.min_contribution, b.min_contribution);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(std::pair(a.reorder, a.prediction), std::pair(b.reorder, b.prediction));
  EXPECT_EQ(std::pair(a.direct_light, a.shadows), std::pair(b.direct_light, b.shadows));
  EXPECT_EQ(std::pair(a.specular, a.filters), std::pair(b.specular, b.filters));
  EXPECT_EQ(a.constant_half, b.constant_half);
}

TEST(Plan, RoundTripsThroughRequest) {
  RenderRequest turned = size(97, 31);
  turned.azimuth_degrees = 1.0 / 3;
  turned.elevation_degrees = -12.5;
  turned.pan = Vec3d(0.1, -1e-7, 3e5);
  turned.fov_degrees = 33.3;
  turned.time = 0.7;
  turned.seed = std::uint64_t{1} << 53;
  turned.min_contribution = 1e-3;
  turned.prediction = Prediction::last;
  RenderRequest cast;
  cast.technique = "raycast";
  for (const std::string& name : sample_names()) {
    const auto scene = load(sample(name));
    for (const RenderRequest& request : {RenderRequest(), turned, cast}) {
      SCOPED_TRACE(name + " " + to_json(request));
      const Plan plan = make_plan(*scene, request);
      EXPECT_NE(settings_of(plan).precision, Precision::automatic);  // the plan has chosen a type
      const std::string written = to_json(settings_of(plan));
      for (const RenderOption& option : render_options())
        EXPECT_TRUE(option.given(read_request(parse_document(written)))) << option.key;
      const Plan again = make_plan(*scene, read_request(parse_document(written)));
      expect_same_picture(plan, again);
      EXPECT_EQ(to_json(settings_of(again)), written);
    }
  }
}

}  // namespace
}  // namespace orrery::test
