#include <gtest/gtest.h>

#include <cmath>

#include "core/atmospheres/depth_cue.h"
#include "core/atmospheres/registry.h"
#include "tests/support/pictures.h"

namespace orrery::test {
namespace {

const Vec3d kLight(0.9, 0.5, 0.25), kColor(0.1, 0.3, 0.8);

// Walls that emit kLight and reflect nothing, at these distances from a parallel camera, side by side.
Json walls(const std::vector<double>& distances, const Json& atmosphere) {
  Json objects = Json::array();
  for (std::size_t i = 0; i < distances.size(); ++i)
    objects.push_back({{"type", "rectangle"},
                       {"corner", {static_cast<double>(i), -1, -distances[i]}},
                       {"edge_u", {1, 0, 0}},
                       {"edge_v", {0, 2, 0}},
                       {"material", "shining"}});
  const double width = static_cast<double>(distances.size());
  return scene_with(
      objects,
      {{"materials", {{"shining", {{"type", "lambert"}, {"reflectance", 0}, {"emission", numbers(kLight)}}}}},
       {"camera",
        {{"type", "orthographic"},
         {"eye", {width / 2, 0, 0}},
         {"look_at", {width / 2, 0, -1}},
         {"height", 1}}},
       {"atmosphere", atmosphere}});
}

RenderRequest walls_request(std::size_t walls, const char* technique) {
  RenderRequest request = in_double(size(static_cast<int>(walls), 1));
  request.technique = technique;
  if (std::string_view(technique) == "path" || std::string_view(technique) == "distributed")
    request.samples = 1;
  return request;
}

constexpr const char* kTechniques[] = {"flat",    "gouraud",     "phong", "raycast",
                                       "whitted", "distributed", "path"};

void expect_near(const Vec3f& got, const Vec3d& expected, double tolerance, const std::string& where) {
  EXPECT_NEAR(got.x, expected.x, tolerance) << where;
  EXPECT_NEAR(got.y, expected.y, tolerance) << where;
  EXPECT_NEAR(got.z, expected.z, tolerance) << where;
}

// Techniques that end paths at random are compared within the noise of many samples.
void expect_share(const Json& scene, double share, const char* technique) {
  RenderRequest request = walls_request(1, technique);
  const bool random = request.samples.has_value();
  if (random) request.samples = 4096;
  expect_near(render(scene, request).at(0, 0), kLight * share + kColor * (1 - share), random ? 5e-3 : 1e-5,
              technique);
}

TEST(Atmospheres, HasTestsForAllTypes) { ASSERT_EQ(atmosphere_types().size(), 2u); }

TEST(DepthCue, BlendsByDepthBetweenPlanes) {
  const std::vector<double> distances{1, 3.999, 4, 5, 7, 12, 12.001, 100};
  const double front = 4, back = 12, front_scale = 0.9, back_scale = 0.2;
  const Json cue = {{"type", "depth_cue"}, {"color", numbers(kColor)},   {"front", front},
                    {"back", back},        {"front_scale", front_scale}, {"back_scale", back_scale}};
  for (const char* technique : kTechniques) {
    const Picture picture = render(walls(distances, cue), walls_request(distances.size(), technique));
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const double depth = std::clamp(distances[i], front, back);
      const double share =
          back_scale + (back - depth) * (front_scale - back_scale) / (back - front);  // as in the slides
      expect_near(picture.at(static_cast<int>(i), 0), kLight * share + kColor * (1 - share), 1e-6,
                  std::string(technique) + " at " + std::to_string(distances[i]));
    }
  }
}

// A wall fills the view of a perspective camera. Its depth is the same in all pixels, its distance is not.
TEST(DepthCue, UsesDepthAlongViewAxis) {
  Json scene = walls({0}, {{"type", "depth_cue"}, {"color", {0, 0, 0}}, {"front", 2}, {"back", 6}});
  scene["objects"][0]["corner"] = {-50, -50, -3};
  scene["objects"][0]["edge_u"] = {100, 0, 0};
  scene["objects"][0]["edge_v"] = {0, 100, 0};
  scene["camera"] = {
      {"type", "perspective"}, {"eye", {0, 0, 0}}, {"look_at", {0, 0, -1}}, {"fov_degrees", 100}};
  for (const char* technique : {"phong", "whitted"}) {
    RenderRequest request = walls_request(8, technique);
    request.height = 8;
    const Picture picture = render(scene, request);
    for (const auto& [x, y] : {std::pair(0, 0), {4, 4}, {7, 3}})
      expect_near(picture.at(x, y), kLight * 0.75, 1e-5, technique);  // phong rounds to subpixels
  }
}

TEST(DepthCue, ReachesScalesExactlyAtPlanes) {
  for (const double front : {0.1, 1.0 / 3, 7.7}) {
    const DepthCue<double> cue{Vec3d(0), front, front * 3.3, 0.7, 0.3};
    EXPECT_EQ(cue.share(0, cue.front), 0.7);
    EXPECT_EQ(cue.share(0, cue.back), 0.3);
    EXPECT_NEAR(cue.share(0, std::nextafter(cue.front, 1e9)), 0.7, 1e-15);
    EXPECT_NEAR(cue.share(0, std::nextafter(cue.back, 0.0)), 0.3, 1e-15);
  }
}

TEST(DepthCue, KeepsBackgroundAndReflections) {
  const Json cue = {{"type", "depth_cue"}, {"color", {0, 0, 0}}, {"front", 0}, {"back", 1}};
  Json scene = walls({5}, cue);
  scene["background"] = {0.5, 0.5, 0.5};
  scene["camera"]["height"] = 8;
  const Picture picture = render(scene, in_double(size(8, 8)));
  expect_near(picture.at(0, 0), Vec3d(0.5), 0, "background");
  expect_near(picture.at(4, 4), Vec3d(0), 0, "wall behind the back plane");
}

TEST(Fog, AttenuatesExponentiallyInEveryTechnique) {
  const std::vector<double> distances{0.25, 1, 2, 5, 10, 40, 500};
  const Json fog = {{"type", "fog"}, {"color", numbers(kColor)}, {"mean_free_path", 5}};
  for (const char* technique : kTechniques) {
    const Picture picture = render(walls(distances, fog), walls_request(distances.size(), technique));
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const double share = std::exp(-distances[i] / 5);
      expect_near(picture.at(static_cast<int>(i), 0), kLight * share + kColor * (1 - share), 1e-6,
                  std::string(technique) + " at " + std::to_string(distances[i]));
    }
  }
}

TEST(Fog, HidesBackground) {
  const Json fog = {{"type", "fog"}, {"color", numbers(kColor)}, {"mean_free_path", 5}};
  Json scene = walls({5}, fog);
  scene["camera"]["height"] = 8;
  for (const char* technique : kTechniques) {
    RenderRequest request = walls_request(8, technique);
    request.height = 8;
    expect_near(render(scene, request).at(0, 0), kColor, 1e-7, technique);
  }
  scene["background"] = {0, 0, 0};
  EXPECT_EQ(first_problem(scene), "/background");
}

// A ray passes 3 m to a mirror and 4 m to the wall.
TEST(Fog, AttenuatesMirroredRays) {
  Json scene = walls({0}, {{"type", "fog"}, {"color", numbers(kColor)}, {"mean_free_path", 5}});
  scene["objects"][0]["corner"] = {-10, -10, 1};
  scene["objects"][0]["edge_u"] = {20, 0, 0};
  scene["objects"][0]["edge_v"] = {0, 20, 0};
  scene["objects"].push_back(
      {{"type", "plane"}, {"point", {0, 0, -3}}, {"normal", {0, 0, 1}}, {"material", "mirror"}});
  scene["materials"]["mirror"] = {{"type", "reflective"}, {"n", {1, 1, 1}}, {"k", {1e6, 1e6, 1e6}}};
  const double share = std::exp(-7.0 / 5);
  for (const char* technique : {"whitted", "distributed", "path"}) expect_share(scene, share, technique);
}

// A slab of glass with the index of air, 2 m thick, in front of a wall at 5 m.
TEST(Fog, LeavesLightInsideObjectsUnchanged) {
  Json scene = walls({5}, {{"type", "fog"}, {"color", numbers(kColor)}, {"mean_free_path", 5}});
  scene["objects"].push_back(
      {{"type", "box"}, {"min", {-9, -9, -3}}, {"max", {9, 9, -1}}, {"material", "air"}});
  scene["materials"]["air"] = {{"type", "refractive"}, {"ior", 1}};
  const double share = std::exp(-3.0 / 5);
  for (const char* technique : {"whitted", "distributed", "path"}) expect_share(scene, share, technique);
}

// Inside an emitting sphere of radius 2 m, every direction at the centre sees the same radiance, for sampled
// lights and for sampled directions.
TEST(Fog, AttenuatesLightSourcesAsRays) {
  Json scene = scene_of(
      "[{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, 1], 'radius': 0.001,"
      "  'material': 'matt'},"
      " {'type': 'sphere', 'center': [0, 0, 0], 'radius': 2, 'material': 'lamp'}]");
  scene["materials"] = {{"matt", {{"type", "lambert"}, {"reflectance", 0.5}}},
                        {"lamp", {{"type", "lambert"}, {"reflectance", 0}, {"emission", numbers(kLight)}}}};
  scene["camera"] = {
      {"type", "orthographic"}, {"eye", {0, 0, 1}}, {"look_at", {0, 0, 0}}, {"height", 0.0005}};
  scene["atmosphere"] = {{"type", "fog"}, {"color", {0, 0, 0}}, {"mean_free_path", 3}};
  const Vec3d expected = kLight * (0.5 * std::exp(-2.0 / 3) * std::exp(-1.0 / 3));
  for (const char* technique : {"distributed", "path"}) {
    RenderRequest request = in_double(size(8, 8));
    request.technique = technique;
    request.samples = 64;
    const Picture picture = render(scene, request);
    expect_near(Vec3f(Vec3d(picture.sum(&Vec3f::x), picture.sum(&Vec3f::y), picture.sum(&Vec3f::z)) / 64.0),
                expected, 2e-3, technique);
  }
}

TEST(Fog, AttenuatesPointLights) {
  Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1], 'material': 'matt'}]");
  scene["materials"] = {{"matt", {{"type", "lambert"}, {"reflectance", 1}}}};
  scene["lights"] = Json::array({{{"type", "point"}, {"position", {0, 0, 2}}}});
  scene["camera"] = {
      {"type", "orthographic"}, {"eye", {0, 0, 1}}, {"look_at", {0, 0, 0}}, {"height", 0.0005}};
  scene["atmosphere"] = {{"type", "fog"}, {"color", {0, 0, 0}}, {"mean_free_path", 3}};
  for (const char* technique : {"phong", "raycast", "whitted", "path"})
    expect_near(render(scene, walls_request(1, technique)).at(0, 0), Vec3d(std::exp(-1.0)), 1e-6, technique);
}

TEST(Atmospheres, RejectsInvalidPlanes) {
  Json scene = walls({5}, {{"type", "depth_cue"}, {"front", 3}, {"back", 3}});
  EXPECT_EQ(first_problem(scene), "/atmosphere/back");
  scene["atmosphere"] = {{"type", "fog"}};
  EXPECT_EQ(first_problem(scene), "/atmosphere");
}

}  // namespace
}  // namespace orrery::test
