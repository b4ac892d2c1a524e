#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/pictures.h"
#include "tests/support/structures.h"

// Pictures in which a structure or a shape once lost hits.
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

TEST_P(HardScenes, AreTheSameByAllStructures) {
  for (const std::string& path : hard_scenes()) {
    std::ifstream file(path);
    const auto scene = load(Json::parse(file));
    const bool underflows = scene->facts.smallest_feature.value < 1e-10;  // in float, where no list is right
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

// Of disks and cylinders whose tilt is below the root of the rounding error.
TEST(NearlyAxisAligned, DisksAndCylindersReachBeyondTheirPlane) {
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
