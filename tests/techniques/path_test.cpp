#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Compares emitted and interreflected light with closed forms.
namespace orrery::test {
namespace {

// Returns a lamp over a floor of reflectance 1. A camera at the side sees the floor below the lamp, but not
// the lamp.
Json over_floor(const Json& lamp) {
  Json scene = scene_of(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
      "{'materials': {'white': {'kd': 1}, 'lamp': {'type': 'rough', 'kd': 0, 'emission': [1, 1, 1]}}}");
  scene["objects"].push_back(lamp);
  scene["objects"].back()["material"] = "lamp";
  return scene;
}
Json square_at(double height) {
  return {{"type", "rectangle"}, {"corner", {-0.5, height, -0.5}}, {"a", {1, 0, 0}}, {"b", {0, 0, 1}}};
}
const Vec3d kBelow(0, 0, 0), kBeside(30, 0.05, 0);

class PathFurnace : public testing::TestWithParam<const char*> {};

// In a closed room whose walls emit 1 and reflect rho, the radiance is the sum of the powers of rho up to the
// depth limit.
TEST_P(PathFurnace, SumsAllBounces) {
  covers("R2 light-11");
  const Json room = scene_of(GetParam(), "{'materials': {'white': {'kd': 0.5, 'emission': [1, 1, 1]}}}");
  for (const int depth : {0, 1, 2, 3, 8, 32}) {
    const Estimate found = estimate(room, Vec3d(0.1, 0.2, 0.3), Vec3d(1, 0.4, -0.5), depth);
    EXPECT_NEAR(found.mean, 2 - std::pow(0.5, depth), 4 * found.error() + 1e-12) << depth;
  }
}
INSTANTIATE_TEST_SUITE_P(
    Rooms, PathFurnace,
    testing::Values("[{'type': 'box', 'min': [-1, -2, -3], 'max': [3, 2, 1]}]",
                    "[{'type': 'cylinder', 'base': [0, -2, 0], 'top': [0, 2, 0], 'radius': 2}]",
                    "[{'type': 'cylinder', 'base': [0.3, -2, 1], 'top': [-0.2, 1, -2], 'radius': 3}]",
                    "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 2}]"));

// Places a unit square at different heights above a point. `sd` is the relative standard deviation of one
// sample by solid angle.
TEST(Path, MatchesIrradianceOfSquare) {
  covers("R9 light-17 light-19");
  struct Case {
    double height, irradiance, sd;
  };
  for (const auto& [height, irradiance, sd] : {Case{2, .073478, .01245}, Case{1, .239457, .04328},
                                               Case{.5, .554127, .1204}, Case{.1, .968340, .4042}}) {
    const Estimate found = estimate(over_floor(square_at(height)), kBeside, kBelow, 1);
    EXPECT_NEAR(found.mean / irradiance, 1, 4 * sd / 32 + 1e-4) << height;
  }
}

TEST(Path, MatchesIrradianceOfSphereAndDisk) {
  covers("light-17 light-20");
  const Estimate ball =
      estimate(over_floor({{"type", "sphere"}, {"center", {0, 2, 0}}, {"radius", 0.5}}), kBeside, kBelow, 1);
  EXPECT_NEAR(ball.mean, 0.5 * 0.5 / 4, 4 * ball.error() + 1e-9);
  const Estimate disk =
      estimate(over_floor({{"type", "disk"}, {"center", {0, 2, 0}}, {"normal", {0, -1, 0}}, {"radius", 0.5}}),
               kBeside, kBelow, 1);
  EXPECT_NEAR(disk.mean, 0.25 / (4 + 0.25), 4 * disk.error() + 1e-9);
}

// Adds balls of radiance 1, and adds to `irradiance` the sum of (radius / distance)^2 times the cosine, the
// radiance of the floor.
Json with_balls(Json scene, const std::vector<Vec3d>& from_point, const Vec3d& point,
                double share_of_distance, double& irradiance) {
  for (const Vec3d& centre : from_point) {
    irradiance += share_of_distance * share_of_distance * centre.y / length(centre);
    scene["objects"].push_back({{"type", "sphere"},
                                {"center", numbers(point + centre)},
                                {"radius", share_of_distance * length(centre)},
                                {"material", "lamp"}});
  }
  return scene;
}
const Json kWhiteFloor = scene_of(
    "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
    "{'materials': {'white': {'kd': 1}, 'lamp': {'type': 'rough', 'kd': 0, 'emission': [1, 1, 1]}}}");

// BSDF samples and light samples hit large balls equally often. Small balls are added at another place.
TEST(Path, MatchesIrradianceOfNearAndFarLamps) {
  covers("light-17");
  const Vec3d point(3, 0, 2);
  for (const int small : {0, 24}) {
    double expected = 0;
    Json scene =
        with_balls(kWhiteFloor, {Vec3d(0.2, 2, 0), Vec3d(12, 12, 2), Vec3d(-7, 9, 4)}, point, 0.3, expected);
    std::vector<Vec3d> others;
    for (int i = 0; i < small; ++i) others.push_back(Vec3d(-3 - 0.05 * i, 0.1, 2.5 - 0.2 * i));
    scene = with_balls(scene, others, point, 0.01, expected);
    const Estimate found = estimate(scene, point + Vec3d(30, 0.05, 0), point, 1);
    EXPECT_NEAR(found.mean / expected, 1, 4 * found.error() / expected) << small;
    EXPECT_LT(found.sd / expected, 0.5) << small;
  }
}

TEST(Path, AddsSunAndLamp) {
  covers("light-17");
  const Vec3d point(3, 0, 2);
  double expected = 0.1 * std::cos(0.5);
  Json scene = with_balls(kWhiteFloor, {Vec3d(-1, 1.5, 0)}, point, 0.4, expected);
  scene["lights"] = Json::array({{{"type", "directional"},
                                  {"direction_to_light", {std::sin(0.5), std::cos(0.5), 0}},
                                  {"intensity", {0.1, 0.1, 0.1}},
                                  {"angle_degrees", 60}}});
  const Estimate found = estimate(scene, point + Vec3d(30, 0.05, 0), point, 1);
  EXPECT_NEAR(found.mean / expected, 1, 4 * found.error() / expected);
}

// A reflective lamp in an empty scene is flat, or convex and seen from outside, so no light reaches it.
TEST(Path, AvoidsSelfLightingOfConvexLamps) {
  struct Lamp {
    const char* text;
    Vec3d middle;
  };
  for (const auto& [text, middle] :
       {Lamp{"{'type': 'rectangle', 'corner': [0.1, 0.2, -0.3], 'edge_u': [0.5, 0.2, 0.1], 'edge_v': [-0.2, "
             "0.4, 0.2]}",
             Vec3d(0.25, 0.5, -0.15)},
        Lamp{"{'type': 'disk', 'center': [0.3, 0.4, -0.2], 'normal': [0.3, 0.5, 0.8], 'radius': 0.5}",
             Vec3d(0.3, 0.4, -0.2)},
        Lamp{"{'type': 'sphere', 'center': [1000, 1000, 1000], 'radius': 0.2}", Vec3d(1000, 1000, 1000)},
        Lamp{"{'type': 'sphere', 'center': [0.1, 0.2, 0.3], 'radius': 0.4}", Vec3d(0.1, 0.2, 0.3)},
        Lamp{"{'type': 'box', 'min': [-0.2, -0.1, -0.3], 'max': [0.4, 0.5, 0.2]}", Vec3d(0.1, 0.2, 0.2)},
        Lamp{"{'type': 'cylinder', 'base': [-1, 0.2, 0.1], 'top': [1, 0.2, 0.1], 'radius': 0.3}",
             Vec3d(0, 0.2, 0.4)},
        Lamp{"{'type': 'cylinder', 'base': [0, 0, -1], 'top': [0, 0, 0.1], 'radius': 0.3}",
             Vec3d(0.1, 0.05, 0.1)}}) {
    const Json scene =
        scene_with(json(text), Json{{"materials", {{"white", {{"kd", 0.9}, {"emission", {1, 1, 1}}}}}}});
    EXPECT_EQ(estimate(scene, middle + Vec3d(0.3, 0.4, 3), middle, 4).mean, 1) << text;
  }
}

// An emitter that encloses all other objects is not sampled, because every point sees it from inside. Light
// samples are used for other lamps instead.
TEST(Path, SkipsLightSamplingOfEnclosingLamps) {
  const auto is_drawn_from = [](std::string_view objects) {
    const Json scene =
        scene_of(objects, "{'materials': {'white': {'emission': [1, 1, 1]}, 'dark': {'type': 'rough'}}}");
    return Tracing(scene).world().geometry->emitters != nullptr;
  };
  const std::string room = "{'type': 'box', 'min': [-2, -2, -2], 'max': [2, 2, 2]}";
  const std::string tank = "{'type': 'cylinder', 'base': [0, -2, 0], 'top': [0, 2, 0], 'radius': 2}";
  const auto ball = [](double x) {
    return "{'type': 'sphere', 'material': 'dark', 'radius': 0.5, 'center': [" + std::to_string(x) +
           ", 0, 0]}";
  };
  for (const std::string& around : {room, tank}) {
    EXPECT_FALSE(is_drawn_from("[" + around + "," + ball(1) + "]"));
    EXPECT_TRUE(is_drawn_from("[" + around + "," + ball(3) + "]")) << "the emitter lights an object outside";
  }
}

// Compares a square with a mesh of 100,352 triangles. Each vertex of a path samples one triangle.
TEST(Path, MatchesSingleEmitterWithManyTriangles) {
  constexpr int kSide = 224;
  Json positions = Json::array(), indices = Json::array();
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x)
      positions.push_back({static_cast<double>(x) / kSide - 0.5, 1, static_cast<double>(y) / kSide - 0.5});
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int a = y * (kSide + 1) + x, b = a + kSide + 1;
      indices.push_back({a, a + 1, b});
      indices.push_back({a + 1, b + 1, b});
    }
  Json scene = over_floor({{"type", "mesh"}, {"positions", positions}, {"indices", indices}});
  scene["camera"] = {
      {"type", "perspective"}, {"eye", {30, 0.05, 0}}, {"look_at", {0, 0, 0}}, {"fov_degrees", 1e-3}};
  for (RenderRequest request : {in_float(size(8, 8)), in_double(size(8, 8))}) {
    request.technique = "path";
    request.max_depth = 1;
    request.samples = 256;
    EXPECT_NEAR(render(scene, request).sum() / 64 / .239457, 1, 0.01);
  }
}

// Path reuse does not change the mean, and lowers the error of a pixel.
TEST(Path, ChangesOnlyNoiseWithPathReuse) {
  covers("light-8 light-9");
  const auto box = load(sample("cornell-box"));
  const auto picture = [&](int reuse, int samples, std::uint64_t seed) {
    const int side = samples > 16 ? 64 : 160;
    RenderRequest request = size(side, side);
    request.reuse = reuse;
    request.samples = samples;
    request.seed = seed;
    return render(box, request);
  };
  const auto mean_square = [](const Picture& a, const Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      sum += std::pow(double{a.pixels[i].x} - b.pixels[i].x, 2);
    return sum / static_cast<double>(a.pixels.size());
  };
  const Picture alone = picture(1, 256, 1);
  const double pixels = 64 * 64, mean = alone.sum() / pixels;
  const double noise = mean_square(picture(1, 16, 2), picture(1, 16, 3));
  for (const int reuse : {4, 8, 16}) {
    EXPECT_NEAR(picture(reuse, 256, 1).sum() / pixels / mean, 1, 4e-3) << reuse;
    const double shared_noise = mean_square(picture(reuse, 16, 2), picture(reuse, 16, 3));
    EXPECT_LT(shared_noise, noise * (reuse == 16 ? 0.25 : 0.5)) << reuse;
  }
}

// Paths of other pixels could not have sampled light that one path finds through a mirror.
TEST(Path, ExcludesMirrorLightFromReuse) {
  const auto room = load(scene_of(
      "[{'type': 'box', 'min': [-2, -1, -2], 'max': [2, 2, 5]}, {'type': 'sphere', 'center': [0.9, -0.4, 0],"
      "'radius': 0.6, 'material': 'mirror'}, {'type': 'rectangle', 'corner': [-1, 1.9, -1], 'edge_u': [1, 0, "
      "0],"
      "'edge_v': [0, 0, 1], 'material': 'lamp'}]",
      "{'materials': {'white': {'kd': 0.6}, 'mirror': {'type': 'metal', 'n': [0, 0, 0], 'k': [1, 1, 1], "
      "'roughness': 0},"
      "'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [5, 5, 5]}}}"));
  const auto mean = [&](int reuse) {
    RenderRequest request = size(64, 64);
    request.technique = "path";
    request.reuse = reuse;
    request.samples = 128;
    return render(room, request).sum();
  };
  EXPECT_NEAR(mean(16) / mean(1), 1, 0.006);
}

TEST(Path, IsIndependentOfSlicesAndThreads) {
  covers("light-7");
  const auto box = load(sample("cornell-box"));
  RenderRequest request = size(80, 72);
  request.samples = 8;
  const Picture whole = render(box, request);
  request.slice = 64;
  EXPECT_TRUE(identical(whole, render(box, request, 1)));
}

}  // namespace
}  // namespace orrery::test
