#pragma once

#include <vector>

#include "core/plan/plan.h"
#include "core/render/renderer.h"
#include "tests/support/scenes.h"

// Whole pictures, rendered through plan, tiles and pool.
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

// Renders a scene. `threads` 0: the shared pool of two.
Picture render(const Json& scene, const RenderRequest& request = {}, int threads = 0);
Picture render(const std::shared_ptr<const Scene>& scene, const RenderRequest& request = {}, int threads = 0);

// Renders a plan of the scene on the shared pool. The film is linear, unless a budget requires sums.
RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request = {},
                      const RenderControl& control = {});
// Returns the values of all pixels and channels in linear radiance. REQUIRES: as Film::image() of linear32.
std::vector<double> linear_values(const Film& film);
// Returns display values, before rounding to codes.
std::vector<double> shown(std::vector<double> linear);
double rms_difference(const std::vector<double>& a, const std::vector<double>& b);

// Returns the pool that tests share.
WorkerPool& shared_pool();

// Returns the largest difference of two pictures of one size in any channel.
double largest_difference(const Picture& a, const Picture& b);
// Returns whether two pictures are bit-identical, so that NaN equals NaN.
bool identical(const Picture& a, const Picture& b);
// Returns the number of pixels that differ by more than `tolerance` in some channel.
int differing_pixels(const Picture& a, const Picture& b, double tolerance);

RenderRequest size(int width, int height);
RenderRequest in_double(RenderRequest request = {});
RenderRequest in_float(RenderRequest request = {});

}  // namespace orrery::test
