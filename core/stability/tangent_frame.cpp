#include <algorithm>
#include <cmath>

#include "core/math/hemisphere.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"

namespace orrery {
namespace {

// Computes tangents as in Frisvad, "Building an Orthonormal Basis from a 3D Unit Vector Without
// Normalization", Journal of Graphics Tools, 2012.
Tangents<float> frisvad_tangents(const Vec3f& n) {
  if (n.z < -0.9999999f) return {{0, -1, 0}, {-1, 0, 0}};
  const float a = 1 / (1 + n.z), b = -n.x * n.y * a;
  return {{1 - n.x * n.x * a, b, -n.x}, {b, 1 - n.y * n.y * a, -n.y}};
}

// Returns the largest deviation of the tangents' lengths from 1, and of dot products of tangents and normal
// from 0.
double error_of(const Tangents<float>& basis, const Vec3f& normal) {
  const Vec3d n(normal), a(basis.first), b(basis.second);
  return std::max({std::abs(length(a) - 1), std::abs(length(b) - 1), std::abs(dot(a, b)), std::abs(dot(a, n)),
                   std::abs(dot(b, n))});
}

StabilityFigures measure() {
  SplitMix random(3);
  StabilityFigures worst{0, 0};
  const auto add = [&](const Vec3f& n) {
    worst.known = std::max(worst.known, error_of(frisvad_tangents(n), n));
    worst.ours = std::max(worst.ours, error_of(tangents_of(n), n));
  };
  add({4.57584625e-4f, 4.55883157e-4f, -0.999999881f});
  for (int i = 0; i < 20'000; ++i) {
    const double reach = i % 2 ? 1e-3 : 1;
    const Vec3d near_the_pole(random.between(-reach, reach), random.between(-reach, reach), -1);
    add(Vec3f(safe_normalize(near_the_pole)));
  }
  return worst;
}

}  // namespace

StabilityRow tangent_frame_row() {
  return {"A30",
          "Tangent frame of a normal",
          "two tangents of unit vectors near -z, in float: largest error of a length or of a dot product",
          "1",
          "1 / (1 + z), with a special case for the pole (Frisvad 2012)",
          0.5,
          "1 / (sign + z) (Duff and others 2017)",
          1e-6,
          measure};
}

}  // namespace orrery
