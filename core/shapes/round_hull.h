#pragma once

#include <cmath>

#include "core/model/shape.h"

namespace orrery {

// Returns the half-extents along x, y and z of a circle of radius 1 perpendicular to the unit vector `axis`.
// A half-extent is sqrt(1 - a^2) for one component a of `axis`. It is computed from the other two components,
// because 1 - a^2 rounds to 0 for a tilt below 1.5e-8 radians.
inline Vec3d round_reach(const Vec3d& axis) {
  return {std::hypot(axis.y, axis.z), std::hypot(axis.x, axis.z), std::hypot(axis.x, axis.y)};
}

// Returns the triangles of the box around a cylinder, aligned with its axis. The box is flat if `half_length`
// is 0.
inline std::vector<HullTriangle> round_hull(const Vec3d& center, const Vec3d& axis, double radius,
                                            double half_length) {
  const Vec3d w = safe_normalize(axis), size = abs(w);
  const Vec3d least = size.x <= size.y && size.x <= size.z ? Vec3d(1, 0, 0)
                      : size.y <= size.z                   ? Vec3d(0, 1, 0)
                                                           : Vec3d(0, 0, 1);
  const Vec3d u = safe_normalize(cross(w, least)), v = cross(w, u);
  const std::array<Vec3d, 3> half{u * radius, v * radius, w * half_length};
  std::vector<HullTriangle> hull;
  for (std::size_t side = 0; side < 3; ++side)
    for (const double sign : {-1.0, 1.0}) {
      const Vec3d middle = center + half[side] * sign;
      const Vec3d a = half[(side + 1) % 3], b = half[(side + 2) % 3];
      hull.push_back({middle - a - b, middle + a - b, middle + a + b});
      hull.push_back({middle - a - b, middle + a + b, middle - a + b});
    }
  return hull;
}

}  // namespace orrery
