#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Compares the thin lens with the lens equation.
namespace orrery::test {
namespace {

// Returns a scene with a small lamp on the axis, 4 m from a lens. `aperture_radius`: radius of the lens in
// metres. `focus`: focus distance in metres. The field of view is 40 degrees.
Json lamp_before_lens(double aperture_radius, double focus) {
  return scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 0.02}]",
                  "{'camera': {'fov_degrees': 40, 'aperture_radius': " + std::to_string(aperture_radius) +
                      ", 'focus_distance': " + std::to_string(focus) +
                      "}, 'materials': {'white': {'kd': 0, 'emission': [1, 1, 1]}}}");
}
Picture picture_of(const Json& scene) {
  RenderRequest request = size(128, 128);
  request.technique = "path";
  request.samples = 64;
  return render(scene, request);
}
constexpr double kPixelAngle = 2 * 0.363970234266202 / 128;  // tangent of the angle of one pixel

// A point at distance z is blurred to a disk of radius r |z - f| / z in the focal plane. The total light
// equals that of a pinhole camera.
TEST(ThinLens, BlursPointToDiskOfExpectedRadius) {
  covers("R26 light-41");
  const double sharp = picture_of(lamp_before_lens(0, 4)).sum();
  for (const double focus : {2.0, 3.0, 8.0}) {
    const double radius = 0.1, pixel = kPixelAngle * focus;
    const Picture blurred = picture_of(lamp_before_lens(radius, focus));
    EXPECT_NEAR(blurred.sum() / sharp, 1, 0.02) << focus;
    // Twice the second moment of a uniform disk is its squared radius. The moments of the lamp and of a pixel
    // add to the moment of the blur.
    double moment = 0;
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x)
        moment +=
            double{blurred.at(x, y).x} * (std::pow(x - 63.5, 2) + std::pow(y - 63.5, 2)) / blurred.sum();
    const double blur = radius * std::abs(4 - focus) / 4 / pixel, lamp = 0.02 * focus / 4 / pixel;
    EXPECT_NEAR(std::sqrt(2 * moment) / std::sqrt(blur * blur + lamp * lamp + 1.0 / 3), 1, 0.02) << focus;
  }
}

TEST(ThinLens, IsSharpAtFocusDistance) {
  const Picture sharp = picture_of(lamp_before_lens(0, 4)), focused = picture_of(lamp_before_lens(0.1, 4));
  EXPECT_NEAR(focused.sum() / sharp.sum(), 1, 0.02);
  EXPECT_LE(focused.brighter_than(0), sharp.brighter_than(0) + 4);
}

TEST(ThinLens, MatchesPinholeWithoutAperture) {
  covers("E12 light-42");
  Json scene = sample("cornell-box");
  RenderRequest request = size(48, 48);
  request.samples = 2;
  const Picture pinhole = render(scene, request);
  scene["camera"]["focus_distance"] = 0.5;
  EXPECT_TRUE(identical(pinhole, render(scene, request)));
  scene["camera"]["aperture_radius"] = 0.01;
  EXPECT_FALSE(identical(pinhole, render(scene, request)));
}

}  // namespace
}  // namespace orrery::test
