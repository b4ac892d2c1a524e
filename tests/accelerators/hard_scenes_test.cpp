#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "tests/support/pictures.h"
#include "tests/support/random.h"
#include "tests/support/structures.h"

// Compares structures with the list in scenes of extreme proportions, where rounding errors can lose hits.
namespace orrery::test {
namespace {

std::vector<std::string> hard_scenes() {
  std::vector<std::string> paths;
  for (const char* folder : {"tests/scenes/bounds", "tests/scenes/precision"})
    for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

class HardScenes : public testing::TestWithParam<std::string> {};

TEST_P(HardScenes, RendersIdenticallyToList) {
  for (const std::string& path : hard_scenes()) {
    std::ifstream file(path);
    const auto scene = load(Json::parse(file));
    // In float, such small scenes underflow, and the list is no valid reference.
    const bool underflows = scene->facts.smallest_feature.value < 1e-10;
    for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
      if (underflows && precision == Precision::single_precision) continue;
      const auto by = [&](const std::string& accelerator) {
        RenderRequest request = size(24, 24);
        request.precision = precision;
        request.accelerator = accelerator;
        return render(scene, request);
      };
      EXPECT_TRUE(identical(by(GetParam()), by("list"))) << path;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Structures, HardScenes, testing::ValuesIn(accelerator_names()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Returns a scene of narrow triangles near the origin with the given aspect ratio. The image is a few
// triangle widths high.
Json slivers(double aspect, Random& random) {
  constexpr int kCount = 60;
  const double width = 2 / aspect;
  const Vec3d view = random.direction();
  Json objects = Json::array();
  for (int i = 0; i < kCount; ++i) {
    const Vec3d along = random.direction(),
                across = safe_normalize(cross(along, i % 2 ? view : random.direction())) * (width / 2);
    const Vec3d middle = random.in_cube(0.15 * kCount * width) - along * (i % 3 == 0 ? 0.95 : 0.0);
    const double tip = i % 4 == 0 ? -1 : random.between(-0.9, 0.9);
    objects.push_back({{"type", "triangle"},
                       {"vertices",
                        {numbers(middle - along - across), numbers(middle + along - across),
                         numbers(middle + along * tip + across)}},
                       {"material", i % 2 ? "bright" : "dark"}});
  }
  const double field = 2 * std::atan(0.07 * kCount * width) * 180 / std::numbers::pi;
  return {{"version", 1},
          {"camera",
           {{"type", "perspective"},
            {"eye", numbers(view * 3.0)},
            {"look_at", {0, 0, 0}},
            {"up", numbers(random.direction())},
            {"fov_degrees", std::min(120.0, field)}}},
          {"materials",
           {{"bright", {{"type", "rough"}, {"kd", {0.9, 0.8, 0.6}}}},
            {"dark", {{"type", "rough"}, {"kd", {0.1, 0.2, 0.3}}}}}},
          {"lights", {{{"type", "directional"}, {"direction_to_light", numbers(random.direction())}}}},
          {"objects", objects}};
}

class Slivers : public testing::TestWithParam<std::string> {};

TEST_P(Slivers, RendersIdenticallyToList) {
  Random random(41);
  for (int i = 0; i < 60; ++i) {
    const bool in_float = i % 2 == 0;
    const auto scene =
        load(slivers(in_float ? random.magnitude(1e3, 1e7) : random.magnitude(1e6, 1e13), random));
    const auto by = [&](const std::string& accelerator) {
      RenderRequest request = size(32, 32);
      request.precision = in_float ? Precision::single_precision : Precision::double_precision;
      request.accelerator = accelerator;
      return render(scene, request);
    };
    EXPECT_TRUE(identical(by(GetParam()), by("list"))) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Structures, Slivers, testing::ValuesIn(accelerator_names()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// The squares of these tilts are below the rounding error of 1 (1.1e-16).
TEST(ShapeBounds, CoversSlightlyTiltedDisksAndCylinders) {
  for (const double tilt : {1e-8, 1e-12, 1e-100}) {
    const auto bounds = [](const Json& object) {
      const auto scene = load(scene_with(object));
      for (const auto& set : scene->shapes)
        if (set->size() > 0) return set->bounds(0);
      return Boundsd();
    };
    const Boundsd disk =
        bounds({{"type", "disk"}, {"center", {0, 0, 0}}, {"normal", {tilt, 1, 0}}, {"radius", 1}});
    EXPECT_NEAR(disk.hi.y / tilt, 1, 1e-9);
    EXPECT_NEAR(disk.lo.y / tilt, -1, 1e-9);
    const Boundsd column =
        bounds({{"type", "cylinder"}, {"base", {0, 0, 0}}, {"top", {1, 0, tilt}}, {"radius", 1}});
    EXPECT_NEAR(-column.lo.x, tilt, 2e-16);
  }
}

}  // namespace
}  // namespace orrery::test
