#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/materials/fresnel.h"
#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Compares distributed ray tracing with closed forms, and with path tracing where both find the same light.
namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr const char* kLamp = "{'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}";

Json scene_of_materials(std::string_view objects,
                        const std::vector<std::pair<const char*, const char*>>& named,
                        const char* rest = "{}") {
  Json scene = scene_of(objects, rest);
  scene["materials"]["lamp"] = json(kLamp);
  for (const auto& [name, text] : named) scene["materials"][name] = json(text);
  return scene;
}

RenderRequest following(const char* technique, int side, int samples, int max_depth, std::uint64_t seed = 0) {
  RenderRequest request = size(side, side);
  request.technique = technique;
  request.samples = samples;
  request.max_depth = max_depth;
  request.reuse = 1;
  request.seed = seed;
  return request;
}

// Returns balls in three rows over a metal floor, one of each material without a diffuse lobe. The scene has
// lamps, a sky and a lens.
Json without_diffuse_lobes() {
  const char* kMaterials[] = {"{'type': 'metal', 'name': 'gold', 'roughness': 0.4}",
                              "{'type': 'metal', 'name': 'silver', 'roughness': 0}",
                              "{'type': 'glass', 'roughness': 0}",
                              "{'type': 'glass', 'roughness': 0.5, 'filter': [0.5, 0.9, 0.7]}",
                              "{'type': 'plastic', 'reflectance': 0, 'roughness': 0}",
                              "{'type': 'plastic', 'reflectance': 0, 'roughness': 0.4}",
                              "{'type': 'metallic-roughness', 'metallic': 1, 'roughness': 0.5}",
                              "{'type': 'cook-torrance', 'diffuse': 0, 'specular': [0.9, 0.6, 0.3]}",
                              "{'type': 'translucent', 'reflectance': 0, 'transmittance': [0.9, 0.8, 0.5]}",
                              "{'type': 'rough', 'kd': 0, 'ks': [0.9, 0.7, 0.8], 'shininess': 20}",
                              "{'type': 'rough', 'kd': 0, 'ks': 0.8, 'shininess': 5, 'shading': 'phong'}",
                              "{'type': 'reflective', 'n': [0.14, 0.16, 0.13], 'k': [4.1, 2.3, 3.1]}"};
  Json scene = scene_of_materials(
      "[{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0], 'material': 'floor'},"
      " {'type': 'rectangle', 'corner': [-2, 3, -2], 'edge_u': [2, 0, 0], 'edge_v': [0, 0, 2], 'material': "
      "'lamp'},"
      " {'type': 'cylinder', 'base': [2, 1, -2], 'top': [2, 2, -2], 'radius': 0.3, 'material': 'lamp'}]",
      {{"floor", "{'type': 'metal', 'name': 'copper', 'roughness': 0.3}"}},
      "{'camera': {'eye': [0, 1, 6], 'look_at': [0, 0, 0], 'aperture_radius': 0.1, 'focus_distance': 6},"
      " 'lights': [{'type': 'point', 'position': [3, 4, 5]}],"
      " 'environment': {'type': 'gradient', 'zenith': [0.1, 0.2, 0.4], 'horizon': [0.4, 0.4, 0.3]}}");
  int number = 0;
  for (const char* material : kMaterials) {
    const std::string name = "m" + std::to_string(number);
    scene["materials"][name] = json(material);
    scene["objects"].push_back({{"type", "sphere"},
                                {"center", {-1.8 + 1.2 * (number % 4), -0.6 + 0.9 * (number / 4), 0}},
                                {"radius", 0.4},
                                {"material", name}});
    ++number;
  }
  return scene;
}

TEST(Distributed, MatchesPathTracingWithoutDiffuseLobes) {
  covers("light-54");
  const auto scene = load(without_diffuse_lobes());
  for (const RenderRequest& number : {in_float(), in_double()}) {
    RenderRequest path = following("path", 96, 4, 7, 5), distributed = following("distributed", 96, 4, 7, 5);
    path.precision = distributed.precision = number.precision;
    const Picture expected = render(scene, path);
    EXPECT_GT(expected.brighter_than(0.1F), 96 * 96 / 2);
    EXPECT_TRUE(identical(render(scene, distributed), expected));
  }
}

// Neither threads, slices and structures nor scaling the scene by a power of two change the image.
TEST(Distributed, IsIndependentOfThreadsStructureAndScale) {
  covers("light-7");
  Json own = without_filters(without_diffuse_lobes());
  own["materials"]["floor"] = json("{'type': 'plastic', 'roughness': 0.3}");
  own["materials"]["m0"] = json("{'type': 'translucent'}");
  own["ambient"] = {0.1, 0.1, 0.1};
  const auto scene = load(own);
  RenderRequest request = following("distributed", 72, 4, 5);
  const Picture expected = render(scene, request);
  EXPECT_TRUE(identical(render(scaled(own, 0x1p-12), request), expected));
  request.accelerator = "list";
  request.slice = 64;
  EXPECT_TRUE(identical(render(scene, request, 1), expected));
}

// Returns the fraction of the irradiance of a floor point under a uniform ceiling 1 m above that is due to
// the rectangle between the point above it and (a, b). This is the form factor of a corner (Howell, C-3).
double corner_share(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * kPi);
}

class SoftShadow : public testing::TestWithParam<const char*> {};

// A square lamp is above a white floor, with a screen between them. A point is lit by the part of the lamp
// beyond the edge of the screen.
TEST_P(SoftShadow, MatchesVisiblePartOfLamp) {
  covers("light-17 light-22");
  Json scene = scene_of_materials(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]},"
      " {'type': 'rectangle', 'corner': [-2, 1, -2], 'edge_u': [4, 0, 0], 'edge_v': [0, 0, 4], 'material': "
      "'lamp'},"
      " {'type': 'rectangle', 'corner': [-40, 0.5, -40], 'edge_u': [40, 0, 0], 'edge_v': [0, 0, 80], "
      "'material': "
      "'black'}]",
      {{"black", "{'type': 'lambert', 'reflectance': 0}"}});
  scene["materials"]["white"] = json(GetParam());
  // The edge is at x = 0, half way up, so the point at x sees the lamp from -x on.
  for (const double x : {-1.5, -0.4, 0.0, 0.7}) {
    const auto strip = [&](double to) { return (to < 0 ? -2 : 2) * corner_share(std::abs(to), 2); };
    const double expected = strip(2 - x) - strip(-x - x);
    for (const char* technique : {"distributed", "path"}) {
      const Estimate found = estimate(scene, Vec3d(x, 0.05, 30), Vec3d(x, 0, 0), 1, technique);
      EXPECT_NEAR(found.mean, expected, 4 * found.error() + 1e-9) << technique << " " << x;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Floors, SoftShadow,
                         testing::Values("{'type': 'rough', 'kd': 1}",
                                         "{'type': 'lambert', 'reflectance': 1}",
                                         "{'type': 'translucent', 'reflectance': 1}"));

class DiffuseRoom : public testing::TestWithParam<const char*> {};

// Walls emit 1, reflect half of the light, and receive ambient light. At depth 1 and more, direct and ambient
// light are added to the emission. At depth 0, only ambient light is added.
TEST_P(DiffuseRoom, ShowsOnlyDirectAndAmbientLight) {
  covers("light-11");
  Json room = scene_of_materials(GetParam(), {}, "{'ambient': [0.3, 0.3, 0.3]}");
  room["materials"]["white"] = json("{'type': 'lambert', 'reflectance': 0.5, 'emission': [1, 1, 1]}");
  for (const int depth : {0, 1, 2, 6}) {
    const Estimate found = estimate(room, Vec3d(0.1, 0.2, 0.3), Vec3d(1, 0.4, -0.5), depth, "distributed");
    const double direct = depth > 0 ? 0.5 : 0;
    EXPECT_NEAR(found.mean, 1 + 0.5 * 0.3 + direct, 4 * found.error() + 1e-12) << depth;
  }
}
// A box is not sampled from inside, so rays of diffuse lobes find its light. Spheres are sampled.
INSTANTIATE_TEST_SUITE_P(Rooms, DiffuseRoom,
                         testing::Values("[{'type': 'box', 'min': [-1, -2, -3], 'max': [3, 2, 1]}]",
                                         "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 2}]"));

// A flat floor that reflects 0.6 is lit by skies that are sampled and skies that are not.
TEST(Distributed, LightsDiffuseSurfacesFromSky) {
  covers("light-33");
  for (const char* sky :
       {"{'background': [1, 1, 1]}", "{'environment': {'type': 'constant', 'radiance': [1, 1, 1]}}",
        "{'environment': {'type': 'gradient', 'zenith': [1, 1, 1], 'horizon': [0.5, 0.5, 0.5],"
        "'ground': [9, 9, 9]}}"}) {
    const bool gradient = std::string_view(sky).find("gradient") != std::string_view::npos;
    Json scene = scene_of_materials("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]", {}, sky);
    scene["materials"]["white"] = json("{'type': 'lambert', 'reflectance': 0.6}");
    const Estimate found = estimate(scene, Vec3d(0, 1, 0), Vec3d(1, 0, 0.5), 6, "distributed");
    EXPECT_NEAR(found.mean, 0.6 * (gradient ? 5.0 / 6 : 1), 4 * found.error() + 1e-12) << sky;
  }
}

// One lamp is sampled and another, an ellipsoid, is not. The test compares the light of both on matt and
// coated floors with the direct light of path tracing.
TEST(Distributed, CountsHitAndSampledLampsOnce) {
  covers("light-22");
  Json scene = scene_of_materials(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'it'},"
      " {'type': 'rectangle', 'corner': [0.3, 0.6, -1], 'edge_u': [0.8, 0.4, 0], 'edge_v': [0, 0, 2], "
      "'material': "
      "'lamp'}]",
      {},
      "{'background': [0.2, 0.2, 0.2], 'camera': {'eye': [0, 0.5, 1], 'look_at': [0, 0, 0], 'fov_degrees': "
      "20},"
      " 'models': {'ellipsoid': {'objects': [{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, "
      "'material': "
      "'lamp'}]}},"
      " 'instances': [{'model': 'ellipsoid', 'scale': [0.6, 0.1, 1], 'translate': [-0.5, 1.1, 0]}]}");
  for (const char* material :
       {"{'type': 'lambert', 'reflectance': 0.7}", "{'type': 'plastic', 'roughness': 0.4}",
        "{'type': 'metallic-roughness', 'metallic': 0.4, 'roughness': 0.4}",
        "{'type': 'plastic', 'roughness': 0}", "{'type': 'cook-torrance', 'diffuse': 0.3, 'specular': 0.6}",
        "{'type': 'rough', 'kd': 0.4, 'ks': 0.5, 'shininess': 30}",
        "{'type': 'rough', 'kd': 0.4, 'ks': 0.5, 'shininess': 9, 'shading': 'phong'}"}) {
    scene["materials"]["it"] = json(material);
    const auto loaded = load(scene);
    const Picture path = render(loaded, following("path", 32, 256, 1, 1));
    const Picture distributed = render(loaded, following("distributed", 32, 256, 1, 2));
    EXPECT_NEAR(distributed.sum() / path.sum(), 1, 4e-3) << material;
  }
  // Without a background, no rays are traced in order to find it.
  scene.erase("background");
  scene["materials"]["it"] = json("{'type': 'lambert', 'reflectance': 0.7}");
  const auto loaded = load(scene);
  const double by_path = render(loaded, following("path", 32, 256, 1, 1)).sum();
  EXPECT_NEAR(render(loaded, following("distributed", 32, 256, 1, 2)).sum() / by_path, 1, 4e-3);
}

// A convex ball under a sky receives no light from surfaces. Distributed rays therefore find the same light
// as paths: direct light and reflections of the coat.
TEST(Distributed, MatchesPathsOnConvexCoatedBalls) {
  Json scene = scene_of_materials(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}]", {},
      "{'environment': {'type': 'gradient', 'zenith': [1, 1, 1], 'horizon': [0.2, 0.2, "
      "0.2], 'ground': [0.1, 0, 0]},"
      " 'lights': [{'type': 'directional', 'direction_to_light': [1, 1, 1], 'angle_degrees': 20}]}");
  for (const char* material : {"{'type': 'plastic', 'roughness': 0}", "{'type': 'plastic', 'roughness': 0.5}",
                               "{'type': 'metallic-roughness', 'metallic': 0.4, 'roughness': 0.4}",
                               "{'type': 'cook-torrance', 'diffuse': 0.3, 'specular': 0.6}",
                               "{'type': 'rough', 'kd': 0.4, 'ks': 0.5, 'shininess': 30}"}) {
    scene["materials"]["it"] = json(material);
    const auto loaded = load(scene);
    const double by_path = render(loaded, following("path", 32, 256, 6, 1)).sum();
    EXPECT_NEAR(render(loaded, following("distributed", 32, 256, 6, 2)).sum() / by_path, 1, 4e-3) << material;
  }
}

// In front of a background with the radiance of ambient light, a white object is invisible, with or without a
// coat.
TEST(Ambient, HidesWhiteBeforeEqualBackground) {
  for (const char* white :
       {"{'type': 'plastic', 'roughness': 0, 'reflectance': 1}",
        "{'type': 'plastic', 'roughness': 0.4, 'reflectance': 1}",
        "{'type': 'metallic-roughness', 'base_color': 1, 'metallic': 0, 'roughness': 0.4}",
        "{'type': 'lambert', 'reflectance': 1}"})
    for (const char* technique : {"raycast", "whitted", "distributed"}) {
      const auto scene = load(
          scene_of_materials("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}]",
                             {{"it", white}}, "{'ambient': [0.4, 0.4, 0.4], 'background': [0.4, 0.4, 0.4]}"));
      RenderRequest request = in_double(size(32, 32));
      request.technique = technique;
      request.samples = 4;
      // The largest depth at which the image has no noise.
      request.max_depth = technique == std::string("distributed") ? 0 : 5;
      const Picture picture = render(scene, request);
      const int border = *request.max_depth == 0 ? 12 : 0;  // the background has more samples than the ball
      for (int y = border; y < 32 - border; ++y)
        for (int x = border; x < 32 - border; ++x)
          ASSERT_NEAR(picture.at(x, y).x, 0.4, 2e-3) << white << technique << " " << x << " " << y;
    }
}

// In ambient light, a polished floor mirrors a diffuse ceiling. The coat reflects by Fresnel's equations, and
// the base reflects the transmitted ambient light.
TEST(Distributed, ReflectsDiffuseWallsInCoat) {
  Json scene = scene_of_materials(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0], 'material': 'it'},"
      " {'type': 'plane', 'point': [0, 4, 0], 'normal': [0, -1, 0], 'material': 'ceiling'}]",
      {{"it", "{'type': 'plastic', 'roughness': 0, 'reflectance': 0.5}"},
       {"ceiling", "{'type': 'lambert', 'reflectance': 0.5}"}},
      "{'ambient': [1, 1, 1]}");
  for (const double cosine : {0.9, 0.5, 0.2}) {
    const Estimate found =
        estimate(scene, Vec3d(0, 1, 0), Vec3d(std::sqrt(1 / (cosine * cosine) - 1), 0, 0), 3, "distributed");
    const double base = Probe<double>("{'type': 'plastic', 'roughness': 0, 'reflectance': 0.5}")
                            .ambient({.direction = -tilted(cosine)}, Lobes::diffuse)
                            .x;
    const double mirrored = split_dielectric(1 / 1.5, cosine).reflectance;
    EXPECT_NEAR(found.mean, base + mirrored * 0.5, 1e-9) << cosine;
    EXPECT_LT(found.sd, 1e-6) << cosine;
  }
}

// In ambient light, a translucent sheet is between the eye and a diffuse ceiling. The sheet reflects ambient
// light and transmits the radiance of the ceiling.
TEST(Distributed, TransmitsLightThroughSheets) {
  Json scene = scene_of_materials(
      "[{'type': 'rectangle', 'corner': [-500, 1, -500], 'edge_u': [1000, 0, 0], 'edge_v': [0, 0, 1000], "
      "'material': "
      "'sheet'},"
      " {'type': 'plane', 'point': [0, 2, 0], 'normal': [0, -1, 0], 'material': 'ceiling'}]",
      {{"sheet", "{'type': 'translucent', 'reflectance': 0.3, 'transmittance': 0.6}"},
       {"ceiling", "{'type': 'lambert', 'reflectance': 0.5}"}},
      "{'ambient': [1, 1, 1]}");
  const Estimate found = estimate(scene, Vec3d(0, 0, 0), Vec3d(0.1, 1, 0), 3, "distributed");
  EXPECT_NEAR(found.mean, 0.3 + 0.6 * 0.5, 4 * found.error() + 1e-9);
  // The emission of the ceiling is transmitted once. No other light is added.
  scene["materials"]["ceiling"]["emission"] = {2, 2, 2};
  scene["ambient"] = {0, 0, 0};
  const Estimate lit = estimate(scene, Vec3d(0, 0, 0), Vec3d(0.1, 1, 0), 1, "distributed");
  EXPECT_NEAR(lit.mean, 0.6 * 2, 4 * lit.error() + 1e-9);
}

// Only paths find light reflected between two diffuse walls.
TEST(Distributed, OmitsLightBetweenDiffuseSurfaces) {
  Json scene = scene_of_materials(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]},"
      " {'type': 'plane', 'point': [-1, 0, 0], 'normal': [1, 0, 0]}]",
      {}, "{'lights': [{'type': 'point', 'position': [1, 1, 0]}]}");
  const double direct = estimate(scene, Vec3d(0, 1, 0), Vec3d(0, 0, 0), 1, "path").mean;
  EXPECT_NEAR(estimate(scene, Vec3d(0, 1, 0), Vec3d(0, 0, 0), 6, "distributed").mean, direct, 1e-12);
  EXPECT_GT(estimate(scene, Vec3d(0, 1, 0), Vec3d(0, 0, 0), 6, "path").mean, direct * 1.1);
}

}  // namespace
}  // namespace orrery::test
