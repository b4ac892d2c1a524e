#pragma once

#include <cmath>
#include <limits>

#include "core/model/batch.h"

namespace orrery {

// Returns the distance to a triangle, or +infinity for a miss (Moeller, Trumbore, "Fast, Minimum Storage
// Ray/Triangle Intersection", Journal of Graphics Tools, 1997). Determinants of at most `epsilon` in
// magnitude count as 0. The published code uses 1e-6. Rays leak between adjacent triangles, so renders do not
// use this function.
template <class T>
T moller_trumbore(const Ray<T>& ray, const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c, T epsilon) {
  constexpr T kMissed = std::numeric_limits<T>::infinity();
  const Vec3<T> ab = b - a, ac = c - a, p = cross(ray.direction, ac);
  const T determinant = dot(ab, p);
  if (std::abs(determinant) <= epsilon) return kMissed;
  const T inverse = 1 / determinant;
  const Vec3<T> from = ray.origin - a, q = cross(from, ab);
  const T u = dot(from, p) * inverse, v = dot(ray.direction, q) * inverse;
  if (u < 0 || u > 1 || v < 0 || u + v > 1) return kMissed;
  const T t = dot(ac, q) * inverse;
  return t > 0 ? t : kMissed;
}

}  // namespace orrery
