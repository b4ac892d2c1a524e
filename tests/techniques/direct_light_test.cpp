#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests direct light: closed forms, sums over lights, and shadows.
namespace orrery::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr const char* kBall = "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]";

Vec3d seen(const Json& scene, const Vec3d& from, const Vec3d& toward) {
  return Tracing(scene).trace(Ray<double>{from, safe_normalize(toward - from)}).radiance;
}

TEST(Ambient, ShowsAlbedoUnderUniformLight) {
  covers("R1");
  for (const double albedo : {1.0, .5, .18}) {
    const Json scene =
        scene_with(json(kBall), Json{{"ambient", {1, 1, 1}}, {"materials", {{"white", {{"kd", albedo}}}}}});
    Random random(1);
    for (int i = 0; i < 50; ++i) EXPECT_EQ(seen(scene, random.direction() * 4, random.in_cube(.5)).x, albedo);
  }
}

// In a closed room whose walls emit radiance Le and reflect nothing, the radiance is Le everywhere.
TEST(Ambient, FillsClosedRoom) {
  const Json room = scene_of("[{'type': 'box', 'min': [-1, -2, -3], 'max': [3, 2, 1]}]",
                             "{'ambient': [2, 2, 2], 'materials': {'white': {'ka': 0.5, 'kd': 0}}}");
  Random random(2);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(seen(room, Vec3d(1, 0, -1), Vec3d(1, 0, -1) + random.direction()).x, 1);
}

TEST(Point, FollowsCosineCubedLaw) {
  covers("R6");
  const double height = 2;
  const Json scene =
      scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]",
               "{'lights': [{'type': 'point', 'position': [0, 0, 2], 'attenuation': [0, 0, 1]}]}");
  for (const double degrees : {0.0, 15.0, 45.0, 60.0, 85.0}) {
    const Vec3d at(height * std::tan(degrees * kRadians), 0, 0);
    EXPECT_NEAR(seen(scene, at + Vec3d(0, 1, 1), at).x,
                std::pow(std::cos(degrees * kRadians), 3) / (height * height), 1e-12);
  }
}

// Compares the mean radiance over the disc of a Lambert sphere with the phase function. The light is `phase`
// degrees from the eye.
TEST(Directional, MatchesPhasesOfLambertSphere) {
  covers("R5");
  RenderRequest request = in_double(size(256, 256));
  request.samples = 16;
  const auto mean = [&](double phase) {
    const double a = phase * kRadians;
    const Json scene = scene_with(
        json(kBall),
        Json{
            {"camera", json("{'type': 'orthographic', 'eye': [0, 0, 5], 'look_at': [0, 0, 0], 'height': 2}")},
            {"lights", {{{"type", "directional"}, {"direction_to_light", {std::sin(a), 0, std::cos(a)}}}}}});
    return render(scene, request).sum() / (std::numbers::pi * 128 * 128);
  };
  EXPECT_NEAR(mean(0), .66667, 2e-4);
  EXPECT_NEAR(mean(45), .50361, 2e-4);
  EXPECT_NEAR(mean(90), .21221, 2e-4);
  EXPECT_NEAR(mean(135), .03220, 2e-4);
}

TEST(Directional, CastsShadowsFromAnyDistance) {
  covers("B18");
  const auto lit = [](double distance, double radius) {
    Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]",
                          "{'lights': [{'type': 'directional', 'direction_to_light': [0, 0, 1]}]}");
    scene["objects"].push_back(
        {{"type", "sphere"}, {"center", {0, 0, distance}}, {"radius", radius}, {"material", "white"}});
    return seen(scene, Vec3d(0, 1, 1), Vec3d()).x;
  };
  EXPECT_EQ(lit(1e12, 1e3), 0);
  EXPECT_EQ(lit(1e6, 1e-3), 0);
  EXPECT_NEAR(lit(-1e12, 1e3), 1, 1e-12) << "behind the surface";
}

TEST(Point, IgnoresOccludersBeyondLight) {
  const auto lit = [](double z) {
    Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]",
                          "{'lights': [{'type': 'point', 'position': [0, 0, 2]}]}");
    scene["objects"].push_back({{"type", "disk"},
                                {"center", {0, 0, z}},
                                {"normal", {0, 0, 1}},
                                {"radius", 0.5},
                                {"material", "white"}});
    return seen(scene, Vec3d(0, 1, 1), Vec3d()).x;
  };
  EXPECT_EQ(lit(1.999999), 0);
  EXPECT_NEAR(lit(2.000001), 1, 1e-12);
}

TEST(Lights, SumsLightsAndAddsAmbientOnce) {
  covers("B13 R31");
  const auto with = [](const std::vector<double>& intensities) {
    Json scene = scene_of(kBall, "{'ambient': [0.125, 0.125, 0.125]}");
    scene["lights"] = Json::array();
    for (const double i : intensities)
      scene["lights"].push_back(
          {{"type", "directional"}, {"direction_to_light", {0.3, 0.2, 1}}, {"intensity", {i, i, i}}});
    return seen(scene, Vec3d(0, 0, 4), Vec3d(.3, .2, 0)).x;
  };
  EXPECT_EQ(with({}), .125);
  EXPECT_NEAR(with({.5, .5}), with({1}), 1e-15);
  EXPECT_NEAR(with({.1, .2, .3, .4}), with({1}), 1e-15);
  EXPECT_NEAR(with({.1, .2, .3, .4}), with({.4, .2, .1, .3}), 1e-12);
}

TEST(Lights, KeepsValuesAboveOne) {
  covers("B12");
  const Json scene = scene_of(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]",
      R"({'lights': [{'type': 'directional', 'direction_to_light': [0, 0, 1], 'intensity': [1, 0.5, 0.5]},
                                             {'type': 'directional', 'direction_to_light': [0, 0, 1], 'intensity': [1, 0.5, 0.5]}]})");
  const Picture picture = render(scene, size(8, 8));
  EXPECT_EQ(picture.at(4, 4), Vec3f(2, 1, 1));
}

// The camera is 1 m above the centre of a square of 2 m x 2 m, under a distant light from above. With a
// single half vector for all points, the corners would be as bright as the centre.
TEST(Highlight, UsesHalfVectorOfEachPoint) {
  covers("B6");
  const Json scene = scene_of("[{'type': 'box', 'min': [-1, -1, -1], 'max': [1, 1, 0]}]",
                              R"({'lights': [{'type': 'directional', 'direction_to_light': [0, 0, 1]}],
                                  'materials': {'white': {'kd': 0, 'ks': 1, 'shininess': 50}}})");
  EXPECT_NEAR(seen(scene, Vec3d(0, 0, 1), Vec3d(1e-9, 0, 0)).x, 1, 1e-12);
  const Vec3d corner(1 - 1e-12, 1 - 1e-12, 0), to_eye = safe_normalize(Vec3d(0, 0, 1) - corner);
  const double exact = std::pow(safe_normalize(to_eye + Vec3d(0, 0, 1)).z, 50);
  EXPECT_NEAR(exact, .00265, 5e-6);
  EXPECT_NEAR(seen(scene, Vec3d(0, 0, 1), corner).x, exact, 1e-12);
}

TEST(Lights, NeverGivesNegativeRadiance) {
  covers("B1 B4");
  Json scene = scene_of(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}, {'type': 'plane', 'point': [0, -1, 0], "
      "'normal': [0, 1, 0]}]",
      R"({'materials': {'white': {'kd': 1, 'ks': 1, 'shininess': 3}},
                            'lights': [{'type': 'directional', 'direction_to_light': [0, 0, -1]}, {'type': 'point', 'position': [0, -3, 0]},
                                       {'type': 'directional', 'direction_to_light': [-0.8, -0.01, 0]}]})");
  for (const char* shading : {"phong", "blinn-phong"}) {
    scene["materials"]["white"]["shading"] = shading;
    for (const Vec3f& pixel : render(scene, size(64, 64)).pixels) EXPECT_GE(pixel.x, 0);
  }
}

// Whitted's model has no caustics, so glass casts a black shadow. This test documents this error of the
// model.
TEST(Glass, CastsBlackShadow) {
  covers("E6");
  const Json scene =
      scene_with(json(R"([{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]},
                                         {'type': 'sphere', 'center': [0, 0, 2], 'radius': 1, 'material': 'glass'}])"),
                 json(R"({'ambient': [0.25, 0.25, 0.25], 'lights': [{'type': 'point', 'position': [0, 0, 6]}],
                                         'materials': {'glass': {'type': 'refractive', 'ior': 1.5}}})"));
  EXPECT_EQ(seen(scene, Vec3d(3, 0, .5), Vec3d()).x, .25);
  EXPECT_GT(seen(scene, Vec3d(3, 0, .5), Vec3d(4, 0, 0)).x, .25);
}

}  // namespace
}  // namespace orrery::test
