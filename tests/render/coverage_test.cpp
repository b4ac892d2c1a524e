#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/pictures.h"

// Tests the image area that a shape covers.
namespace orrery::test {
namespace {

// Returns a scene of a ball lit only by ambient light.
Json ball(double radius, const Json& camera) {
  return scene_with(Json{{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", radius}},
                    Json{{"camera", camera}, {"ambient", {1, 1, 1}}});
}
Json orthographic(double height) {
  return {{"type", "orthographic"}, {"eye", {0, 0, 5}}, {"look_at", {0, 0, 0}}, {"height", height}};
}

TEST(Coverage, ShowsTinyBallsLikeLargeOnes) {
  covers("A3");
  for (const double radius : {1.0, 1e-3, 1e-5, 1e-9, 1e-11})
    for (const RenderRequest& request : {size(64, 64), in_float(size(64, 64)), in_double(size(64, 64))}) {
      const Json camera{{"eye", {0, 0, 3 * radius}}, {"fov_degrees", 60}};
      EXPECT_NEAR(render(ball(radius, camera), request).brighter_than(0.5f), 1206, 12) << radius;
    }
}

// The rim is complete from 10,000 radii away. The image is 512 pixels wide with 16 samples per pixel.
TEST(Coverage, KeepsRimOfDistantBalls) {
  covers("A20");
  const double distance = 1e4, angle = 2 * std::atan(1.25 / distance) * 180 / std::numbers::pi;
  RenderRequest request = in_double(size(512, 512));
  request.samples = 16;
  const double covered = render(ball(1, {{"eye", {0, 0, distance}}, {"fov_degrees", angle}}), request).sum();
  // Radius of the silhouette in pixels.
  const double radius = 256 / 1.25 / std::sqrt(1 - 1 / (distance * distance));
  EXPECT_NEAR(covered / (std::numbers::pi * radius * radius), 1, 1e-4);
}

TEST(Coverage, MatchesAreaOfDisc) {
  covers("R28");
  const double expected = std::numbers::pi * 20 * 20;
  RenderRequest request = size(64, 64);
  EXPECT_NEAR(render(ball(20, orthographic(64)), request).sum(), expected, 15) << "one ray per pixel";
  request.samples = 64;
  EXPECT_NEAR(render(ball(20, orthographic(64)), request).sum(), expected, 0.5);
}

// A ball with a radius of a fifth of a pixel is at the corner of four pixels. With one ray per pixel, no ray
// hits the ball. With many rays per pixel, some do.
TEST(Coverage, ResolvesSubpixelBallsWithSamples) {
  covers("E7");
  RenderRequest request = size(16, 16);
  EXPECT_EQ(render(ball(.2, orthographic(16)), request).sum(), 0);
  request.samples = 4096;
  EXPECT_NEAR(render(ball(.2, orthographic(16)), request).sum(), .12566, .01);
  EXPECT_NEAR(render(ball(.2, orthographic(16)), request).sum(), .12566, .001)
      << "stratified samples have smaller errors";
}

// The image height determines the scale of both axes: balls are round in images of any aspect ratio.
TEST(Coverage, KeepsBallsRoundInAnyAspect) {
  covers("E9");
  for (const auto& [width, height] : {std::pair{640, 360}, {360, 640}, {1920, 1080}, {100, 400}})
    for (const Json& camera : {Json{{"eye", {0, 0, 10}}, {"fov_degrees", 20}}, orthographic(3)}) {
      const Picture picture = render(ball(1, camera), size(width, height));
      int left = width, right = 0, top = height, bottom = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          if (picture.at(x, y).x > .5f) {
            left = std::min(left, x), right = std::max(right, x);
            top = std::min(top, y), bottom = std::max(bottom, y);
          }
      const int shown = std::min(height, width);  // a tall image clips the ball at the sides
      if (bottom - top < shown) {
        EXPECT_NEAR(right - left, bottom - top, 1) << width << " x " << height;
      }
      EXPECT_NEAR(left + right, width - 1, 1);
      EXPECT_NEAR(top + bottom, height - 1, 1);
    }
}

TEST(Coverage, KeepsMeanOfManySamplesExact) {
  covers("A34");
  Json scene = ball(20, orthographic(4));  // fills the image
  scene["ambient"] = {.1, .1, .1};
  RenderRequest request = size(8, 8);
  request.samples = 4096;
  for (const Vec3f& pixel : render(scene, request).pixels) EXPECT_EQ(pixel.x, .1f);
}

TEST(Coverage, VariesWithSeedOnlyForSeveralSamples) {
  RenderRequest request = size(32, 32);
  const Json scene = ball(10.3, orthographic(32));
  request.samples = 4;
  const Picture a = render(scene, request), again = render(scene, request);
  request.seed = 1;
  const Picture b = render(scene, request);
  EXPECT_TRUE(identical(a, again));
  EXPECT_FALSE(identical(a, b));
  request.samples = 1;
  const Picture centre = render(scene, request);
  request.seed = 2;
  EXPECT_TRUE(identical(centre, render(scene, request)))
      << "a single sample is at the pixel centre for any seed";
}

}  // namespace
}  // namespace orrery::test
