#pragma once

#include <string>
#include <vector>

#include "core/budget/renderer.h"
#include "core/model/plan.h"

// Linear images in memory, renders of a plan, and comparison of two images.
namespace orrery {

struct Picture {
  int width = 0, height = 0;
  std::vector<Vec3f> pixels;  // row by row from the top

  Picture(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  Vec3f& at(int x, int y) { return pixels[static_cast<std::size_t>(y * width + x)]; }
  const Vec3f& at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
};

// Renders the image of the plan as `orrery render` does.
Picture render_picture(const PreparedScene& scene, const Plan& plan);

// Image with one sample per pixel at (dx, dy) pixels from the centre, in double precision.
struct Samples {
  Picture picture;
  std::vector<bool> cut;  // pixels with rays that were omitted as too deep or too weak
};
Samples render_shifted(const PreparedScene& scene, const Plan& plan, float dx, float dy);

// Returns true for each pixel whose centre sees a surface with a shading normal that faces away from the
// viewer.
std::vector<bool> normals_facing_away(const PreparedScene& scene, const Plan& plan);

// Returns the largest absolute difference over the channels, after clamping the values to `brightest`.
float difference(const Vec3f& a, const Vec3f& b, float brightest);

struct Comparison {
  double rms = 0;         // over the channels of the compared pixels
  double rms_of_all = 0;  // over all pixels
  double left_out = 0;    // excluded fraction of the pixels
  double largest = 0;     // largest difference of a compared pixel
  int largest_x = 0, largest_y = 0;
};

// Compares two images with values clamped to `brightest`. `left_out` has one element per pixel and is true
// for excluded pixels.
Comparison compare(const Picture& a, const Picture& b, const std::vector<bool>& left_out, float brightest);

// Returns |a - b| of values clamped to `brightest`, times `gain`. Excluded pixels are blue.
Picture difference_picture(const Picture& a, const Picture& b, const std::vector<bool>& left_out,
                           float brightest, float gain);

void write_png(const Picture& picture, const std::string& path);

}  // namespace orrery
