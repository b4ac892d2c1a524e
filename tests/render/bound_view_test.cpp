// Tests the view of error bounds per pixel.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/render/color_scale.h"
#include "tests/support/pictures.h"

namespace orrery {
namespace {

using test::Json;
using test::json;

// Returns a request without reflections.
RenderRequest flat() {
  RenderRequest r;
  r.technique = "whitted";
  r.max_depth = 0;
  return r;
}

// Pixels of a mirror show the colour of the bound on its omitted reflections. All other pixels show 0.
TEST(BoundView, ShowsBoundOfOmittedLight) {
  const auto loaded = test::load(test::scene_with(
      json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'mirror'}]"),
      Json{{"materials",
            {{"mirror", {{"type", "reflective"}, {"n", {1.0, 1.0, 1.0}}, {"k", {9.0, 9.0, 9.0}}}}}},
           {"ambient", {0.5, 0.5, 0.5}},
           {"background", {0.25, 0.25, 0.25}}}));
  RenderRequest r = flat();
  r.width = r.height = 32;
  r.view = View::bound;
  const RenderResult shown = test::rendered(loaded, r);
  const std::vector<double> values = test::linear_values(shown.film);
  const Vec3d black = color_of_error(0), most = color_of_error(shown.stats.omitted.max());
  ASSERT_GT(shown.stats.omitted.max(), 0.1);
  const auto at = [&](int x, int y) {
    const std::size_t i = static_cast<std::size_t>(y * 32 + x) * 3;
    return Vec3d(values[i], values[i + 1], values[i + 2]);
  };
  EXPECT_NEAR(length(at(0, 0) - black), 0, 1e-6);
  double nearest = 1;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) nearest = std::min(nearest, length(at(x, y) - most));
  EXPECT_LT(nearest, 1e-4) << "some pixel shows the largest bound";
  r.view = View::picture;
  const RenderResult picture = test::rendered(loaded, r);
  EXPECT_EQ(picture.stats.omitted.rms(), shown.stats.omitted.rms()) << "both views report the same bound";
}

// Only pixels whose two halves of the samples differ show noise.
TEST(BoundView, ShowsSamplingNoise) {
  const auto loaded = test::load(
      test::scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]", "{'ambient': [1, 1, 1]}"));
  RenderRequest r = flat();
  r.width = r.height = 64;
  r.samples = 4;
  r.view = View::bound;
  const std::vector<double> values = test::linear_values(test::rendered(loaded, r).film);
  EXPECT_LT(*std::min_element(values.begin(), values.end()), 1e-6) << "background";
  EXPECT_GT(*std::max_element(values.begin(), values.end()), 0.1) << "edge of the ball";
}

TEST(ColorOfError, IncreasesLightnessFromBlackToWhite) {
  EXPECT_EQ(color_of_error(0), Vec3d(0));
  EXPECT_EQ(color_of_error(kBlackError), Vec3d(0));
  EXPECT_NEAR(length(color_of_error(kWhiteError) - Vec3d(1)), 0, 1e-6);
  EXPECT_NEAR(length(color_of_error(std::numeric_limits<double>::infinity()) - Vec3d(1)), 0, 1e-6);
  double before = -1;
  for (double error = kBlackError; error <= kWhiteError; error *= 1.1) {
    const Vec3d c = color_of_error(error);
    const double luminance = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
    EXPECT_GT(luminance, before) << error;
    before = luminance;
  }
}

}  // namespace
}  // namespace orrery
