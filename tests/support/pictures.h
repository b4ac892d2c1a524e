#pragma once

#include <vector>

#include "core/budget/renderer.h"
#include "core/plan/plan.h"
#include "tests/support/scenes.h"

// Images of whole scenes, rendered through plan, tiles and executor.
namespace orrery::test {

struct Picture {
  int width, height;
  std::vector<Vec3f> pixels;  // linear, row 0 at the top
  RenderStats stats;

  const Vec3f& at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
  // Returns the sum of one channel over all pixels.
  double sum(float Vec3f::*channel = &Vec3f::x) const;
  // Returns the number of pixels that are brighter than `level` in some channel.
  int brighter_than(float level) const;
};

// Renders a scene. `threads` = 0 selects the shared pool of two threads.
Picture render(const Json& scene, const RenderRequest& request = {}, int threads = 0);
Picture render(const std::shared_ptr<const Scene>& scene, const RenderRequest& request = {}, int threads = 0);

// Renders a plan of the scene on the shared executor. The film is linear, unless a budget requires sums.
RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request = {},
                      const RenderControl& control = {});
// Returns the linear values of all pixels and channels. REQUIRES: as for Film::image(linear32).
std::vector<double> linear_values(const Film& film);
// Returns the sRGB-encoded values, not rounded to 8 bits.
std::vector<double> shown(std::vector<double> linear);
double rms_difference(const std::vector<double>& a, const std::vector<double>& b);

// Returns the pool of two threads that tests share.
Executor& shared_executor();

// Returns the largest difference of two images of equal size in any channel, or infinity if a difference is
// not finite.
double largest_difference(const Picture& a, const Picture& b);
// Returns true if two images are bit-identical. Equal NaN bits count as identical.
bool identical(const Picture& a, const Picture& b);
// Returns the number of pixels that differ by more than `tolerance` in some channel.
int differing_pixels(const Picture& a, const Picture& b, double tolerance);

RenderRequest size(int width, int height);
RenderRequest in_double(RenderRequest request = {});
RenderRequest in_float(RenderRequest request = {});

}  // namespace orrery::test
