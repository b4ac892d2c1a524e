#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/support/pictures.h"

// Tests the ledger and the radiance range of path tracing.
namespace orrery::test {
namespace {

RenderRequest of_paths(int side, int samples) {
  RenderRequest r = size(side, side);
  r.technique = "path";
  r.precision = Precision::double_precision;
  r.samples = samples;
  return r;
}

// Suns cover the sky, and two suns may overlap.
TEST(RadianceRange, CoversSkyWithAllSunsForPaths) {
  const auto scene =
      load(scene_of("[{'type': 'sphere', 'center': [0, 0, 50], 'radius': 1, 'material': 'black'}]",
                    "{'materials': {'black': {'type': 'lambert', 'reflectance': 0}},"
                    " 'background': [0.5, 0.5, 0.5], 'lights': ["
                    "{'type': 'directional', 'direction_to_light': [0, 0, -1], 'angle_degrees': 90, "
                    "'intensity': [0.4, 0.4, 0.4]},"
                    "{'type': 'directional', 'direction_to_light': [0, 0, -1], 'angle_degrees': 60, "
                    "'intensity': [0.2, 0.2, 0.2]}]}"));
  double brightest = 0;
  for (const double value : linear_values(rendered(scene, of_paths(32, 2)).film))
    brightest = std::max(brightest, value);
  EXPECT_GT(brightest, 1.5);
  EXPECT_LE(brightest, scene->facts.path_radiance.most.x + 1e-6);
  EXPECT_LE(scene->facts.path_radiance.most.x, 1.01 * brightest);
}

// Path reuse does not change the mean of the omitted light.
TEST(PathLedger, IsUnchangedByPathReuse) {
  const auto box = load(sample("cornell-box"));
  RenderRequest r = of_paths(64, 16);
  r.max_depth = 2;
  r.reuse = 1;
  const double alone = rendered(box, r).stats.omitted.mean();
  r.reuse = 16;
  EXPECT_NEAR(rendered(box, r).stats.omitted.mean(), alone, 0.03 * alone);
}

// Light from the background after one reflection is direct light, for a constant background and for a
// gradient.
TEST(Clamp, KeepsBackgroundLight) {
  const std::string even =
      "'zenith': [0.8, 0.8, 0.8], 'horizon': [0.8, 0.8, 0.8], 'ground': [0.8, 0.8, 0.8]}";
  for (const std::string& sky :
       {std::string("'background': [0.8, 0.8, 0.8]"), "'environment': {'type': 'gradient', " + even}) {
    const auto floor =
        load(scene_of("[{'type': 'plane', 'point': [0, -1, 0], 'normal': [0, 1, 0], 'material': 'floor'}]",
                      "{'materials': {'floor': {'type': 'lambert', 'reflectance': 1}}, " + sky + "}"));
    for (const int reuse : {1, 16}) {
      RenderRequest r = of_paths(32, 8);
      r.reuse = reuse;
      r.clamp_indirect = 0.1;
      const RenderResult made = rendered(floor, r);
      EXPECT_EQ(made.stats.clamped.mean(0), 0) << sky << reuse;
      for (const double value : linear_values(made.film)) ASSERT_NEAR(value, 0.8, 0.03) << sky << reuse;
    }
  }
}

}  // namespace
}  // namespace orrery::test
