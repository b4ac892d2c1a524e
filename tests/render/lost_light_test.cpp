// Tests the report of light that a technique does not follow or that paths cannot find.
#include <gtest/gtest.h>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"

namespace orrery::test {
namespace {

// Returns the kinds of light that `technique` does not follow in a scene of a glass ball over a floor with
// the given objects and lights.
std::vector<const char*> not_followed(const char* technique, const std::string& objects,
                                      const std::string& lights) {
  const auto scene = load(
      scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.5, 'material': 'glass'}," + objects +
                   " {'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0], 'material': 'floor'}]",
               "{'materials': {'glass': {'type': 'refractive', 'ior': 1.5},"
               " 'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [9, 9, 9]},"
               " 'floor': {'type': 'lambert', 'reflectance': 0.5}}, 'lights': [" +
                   lights + "]}"));
  RenderRequest r = size(32, 32);
  r.technique = technique;
  r.samples = 2;
  return rendered(scene, r).certificate.not_followed;
}

TEST(Certificate, ListsLightThatTechniqueDoesNotFollow) {
  covers("certificate-21");
  constexpr const char* kPoint = "{'type': 'point', 'position': [0, 3, 0], 'intensity': [1, 1, 1]}";
  constexpr const char* kLamp = "{'type': 'sphere', 'center': [0, 3, 0], 'radius': 0.1, 'material': 'lamp'},";
  EXPECT_EQ(not_followed("distributed", "", kPoint).back(), std::string("caustics"));
  EXPECT_EQ(not_followed("path", "", kPoint).back(), std::string("caustics of lights without extent"));
  EXPECT_TRUE(not_followed("path", kLamp, "").empty());
}

}  // namespace
}  // namespace orrery::test
