#pragma once

#include <string>
#include <vector>

#include "core/model/plan.h"
#include "core/render/renderer.h"

// Linear pictures in memory, our own renders of a plan, and how two pictures differ.
namespace orrery {

struct Picture {
  int width = 0, height = 0;
  std::vector<Vec3f> pixels;  // row by row from the top

  Picture(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  Vec3f& at(int x, int y) { return pixels[static_cast<std::size_t>(y * width + x)]; }
  const Vec3f& at(int x, int y) const { return pixels[static_cast<std::size_t>(y * width + x)]; }
};

// The picture as the program renders it.
Picture render_picture(const PreparedScene& scene, const Plan& plan);

// Every pixel sampled once, (dx, dy) pixels off its centre, in double precision.
struct Samples {
  Picture picture;
  std::vector<bool> cut;  // pixels that a ray which was not traced, too deep or too weak, had a share in
};
Samples render_shifted(const PreparedScene& scene, const Plan& plan, float dx, float dy);

// The pixels whose centre sees a surface with a shading normal that faces away from the viewer.
std::vector<bool> normals_facing_away(const PreparedScene& scene, const Plan& plan);

// Largest difference of a channel, of values up to `brightest`.
float difference(const Vec3f& a, const Vec3f& b, float brightest);

struct Comparison {
  double rms = 0;         // over the channels of the pixels that are compared
  double rms_of_all = 0;  // over all
  double left_out = 0;    // of the pixels
  double largest = 0;     // of their differences
  int largest_x = 0, largest_y = 0;
};

// Values above `brightest` count as it. `left_out` has one entry a pixel.
Comparison compare(const Picture& a, const Picture& b, const std::vector<bool>& left_out, float brightest);

// |a - b| of values up to `brightest`, times `gain`; pixels left out are blue.
Picture difference_picture(const Picture& a, const Picture& b, const std::vector<bool>& left_out,
                           float brightest, float gain);

void write_png(const Picture& picture, const std::string& path);

}  // namespace orrery
