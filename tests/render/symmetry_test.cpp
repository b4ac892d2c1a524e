#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"
#include "tests/support/tracing.h"

// Tests symmetries that need no reference values: linearity, mirroring, rotation and invisible objects.
namespace orrery::test {
namespace {

RenderRequest small() {
  RenderRequest request = size(96, 64);
  request.samples = 1;
  return request;
}

double largest_difference(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, max_component(abs(a[i] - b[i])));
  return largest;
}

const std::vector<std::string> kScenes = {
    "paper",      "mirrors",        "glass",      "light-many",
    "light-spot", "shape-cylinder", "shape-disk", "camera-orthographic"};

TEST(Symmetry, DoublesImageWithDoubledLight) {
  covers("R31");
  for (const std::string& name : kScenes) {
    Json scene = sample(name), bright = scene;
    const auto doubled = [](Json& color) {
      for (Json& channel : color) channel = 2 * channel.get<double>();
    };
    for (Json& light : bright["lights"])
      doubled(light["intensity"] = light.value("intensity", json("[1, 1, 1]")));
    for (const char* key : {"ambient", "background"}) doubled(bright[key]);
    const Picture once = render(scene, small()), twice = render(bright, small());
    int wrong = 0;
    for (std::size_t i = 0; i < once.pixels.size(); ++i) wrong += twice.pixels[i] != once.pixels[i] * 2;
    EXPECT_EQ(wrong, 0) << name;
  }
}

TEST(Symmetry, IgnoresOrderOfLights) {
  covers("R31 B13");
  const Json scene = sample("light-many");
  Json permuted = scene;
  std::reverse(permuted["lights"].begin(), permuted["lights"].end());
  std::swap(permuted["lights"][2], permuted["lights"][7]);
  EXPECT_LE(largest_difference(trace_picture(scene, small()), trace_picture(permuted, small())), 1e-12);
}

TEST(Symmetry, IgnoresOrderOfObjects) {
  covers("R31");
  for (const std::string& name : kScenes) {
    Json permuted = sample(name);
    std::reverse(permuted["objects"].begin(), permuted["objects"].end());
    const Picture expected = render(sample(name), in_double(small())),
                  got = render(permuted, in_double(small()));
    EXPECT_LE(differing_pixels(expected, got, 0), 0) << name;
  }
}

TEST(Symmetry, MirrorsImageWithScene) {
  covers("R31");
  for (const std::string& name : kScenes) {
    const Picture seen = render(sample(name), small()), other = render(mirrored(sample(name)), small());
    int wrong = 0;
    for (int y = 0; y < seen.height; ++y)
      for (int x = 0; x < seen.width; ++x) wrong += seen.at(x, y) != other.at(seen.width - 1 - x, y);
    EXPECT_EQ(wrong, 0) << name;
  }
}

// A camera rolled by 90 degrees gives the rotated image, bit for bit.
TEST(Symmetry, RotatesImageWithCamera) {
  covers("R31");
  for (const char* name : {"paper", "glass", "light-many"}) {
    Json scene = sample(name), turned = scene;
    scene["camera"]["eye"] = turned["camera"]["eye"] = {0, 1, 6};
    scene["camera"]["look_at"] = turned["camera"]["look_at"] = {0, 1, 0};
    turned["camera"]["up"] = {1, 0, 0};
    RenderRequest square = size(64, 64);
    square.samples = 1;
    const Picture seen = render(scene, square), other = render(turned, square);
    int wrong = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) wrong += seen.at(x, y) != other.at(y, 63 - x);
    EXPECT_EQ(wrong, 0) << name;
  }
}

TEST(Symmetry, IgnoresTriangleSplitting) {
  covers("R31");
  const char* patch = R"({'lights': [{'type': 'point', 'position': [1, 2, 3]}], 'ambient': [0.1, 0.1, 0.1],
                          'materials': {'white': {'ks': 0.5}}})";
  const Json whole = scene_of(
      "[{'type': 'triangle', 'vertices': [[-1, -1, 0.5], [1.5, -0.75, 0.25], [0.25, 1, -0.5]]}]", patch);
  const Json split = scene_of(R"([{'type': 'mesh', 'indices': [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
      'positions': [[-1, -1, 0.5], [1.5, -0.75, 0.25], [0.25, 1, -0.5], [0.25, -0.875, 0.375], [0.875, 0.125, -0.125], [-0.375, 0, 0]]}])",
                              patch);
  EXPECT_LE(largest_difference(trace_picture(whole, small()), trace_picture(split, small())), 1e-12);
}

// Returns a ball inside the first opaque body of a scene, where no light can reach it. Returns null if the
// scene has no such body.
Json hidden_ball(const Json& scene) {
  const auto ball = [&scene](const Vec3d& center, double radius) {
    return Json{{"type", "sphere"},
                {"center", numbers(center)},
                {"radius", radius},
                {"material", scene["materials"].begin().key()}};
  };
  for (const Json& object : scene["objects"]) {
    if (scene["materials"][object["material"].get<std::string>()]["type"] != "rough") continue;
    if (object["type"] == "sphere") return ball(vector(object["center"]), object["radius"].get<double>() / 2);
    if (object["type"] == "cylinder" && object.contains("base")) {
      const Vec3d base = vector(object["base"]), top = vector(object["top"]);
      return ball((base + top) / 2, std::min(object["radius"].get<double>(), length(top - base) / 2) / 2);
    }
  }
  return {};
}

TEST(Symmetry, IgnoresHiddenObjects) {
  covers("R31");
  for (const std::string& name : kScenes) {
    Json scene = sample(name);
    const Picture expected = render(scene, small());
    const Json ball = hidden_ball(scene);
    ASSERT_TRUE(ball.is_object()) << name << " has no opaque body";
    scene["objects"].push_back(ball);
    EXPECT_TRUE(identical(expected, render(scene, small()))) << name;
  }
}

TEST(Symmetry, IsTranslationInvariant) {
  covers("A18");
  for (const char* name : {"paper", "light-point", "shape-cylinder"}) {
    const Json far = moved(sample(name), Vec3d(1e6, 1e6, 1e6));
    EXPECT_TRUE(make_plan(*load(far), small()).double_precision) << name;
    EXPECT_LE(test::largest_difference(render(sample(name), in_double(small())), render(far, small())), 1e-6)
        << name;
  }
}

// Compares the view at each pole with the view at a billionth of a degree from it.
TEST(Symmetry, IsContinuousAtOrbitPoles) {
  covers("E8");
  const Json scene =
      scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]",
               "{'camera': {'fov_degrees': 20}, 'lights': [{'type': 'directional', 'direction_to_light': "
               "[1, 2, 3]}], 'ambient': [0.1, 0.1, 0.1]}");
  for (const double pole : {90.0, -90.0}) {
    RenderRequest at = in_double(small()), beside = at;
    at.elevation_degrees = pole;
    beside.elevation_degrees = pole * (1 - 1e-9 / 90);
    EXPECT_LE(test::largest_difference(render(scene, at), render(scene, beside)), 1e-6);
  }
}

}  // namespace
}  // namespace orrery::test
