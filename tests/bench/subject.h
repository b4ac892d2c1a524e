#pragma once

#include <array>
#include <vector>

#include "core/model/batch.h"

// What both sides of a benchmark are given: one mesh, and rays to trace in it.
namespace orrery::bench {

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<unsigned, 3>> triangles;
};

// A closed sphere of about that many triangles, with bumps of several sizes.
Mesh bumpy_sphere(int triangles);

using Rays = std::vector<Ray<float>>;

// Through the pixels of a camera that sees the whole sphere; blocks of 4 x 4 pixels follow each other.
Rays primary_rays();

// One cosine-weighted ray off the surface from each primary hit. `hit_triangle` has the triangle each primary
// ray met, or kNoPrimitive, and `t` how far away.
Rays bounce_rays(const Mesh& mesh, const Rays& primary, const std::vector<int>& hit_triangle,
                 const std::vector<float>& t);

}  // namespace orrery::bench
