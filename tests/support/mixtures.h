#pragma once

#include "tests/support/random.h"
#include "tests/support/rays.h"
#include "tests/support/shapes.h"

// Scenes of many objects around the origin, and rays among them.
namespace orrery::test {

// Returns balls with centres in [-3, 3]^3.
Json balls(int count, std::uint64_t seed);
// Returns all registered shapes, including unbounded ones, at offsets in [-2, 2]^3.
Json mixture(std::uint64_t seed);
// Returns a wavy sheet of 2 * side * side triangles over [-2, 2]^2.
Json wavy_sheet(int side);
// Returns `count` planes near the origin, and three balls.
Json planes(int count, std::uint64_t seed);

// Returns rays with origins in [-half, half]^3 and random directions.
template <class T>
Rays<T> any_rays(double half, int count, std::uint64_t seed) {
  Random random(seed);
  Rays<T> rays;
  for (int i = 0; i < count; ++i)
    rays.push_back({Vec3<T>(random.in_cube(half)), Vec3<T>(random.direction())});
  return rays;
}

template <class T>
Rays<T> rays_from_one_point(double half, int count, std::uint64_t seed) {
  Random random(seed);
  const Vec3<T> origin(random.in_cube(half));
  Rays<T> rays;
  for (int i = 0; i < count; ++i) rays.push_back({origin, Vec3<T>(random.direction())});
  return rays;
}

// Returns rays with many components that are NaN, infinite, huge, zero or denormal.
template <class T>
Rays<T> invalid_rays(int count, std::uint64_t seed) {
  using Limits = std::numeric_limits<T>;
  Random random(seed);
  const std::array<T, 8> odd{Limits::quiet_NaN(),
                             Limits::infinity(),
                             -Limits::infinity(),
                             Limits::max(),
                             -Limits::max(),
                             T(0),
                             T(-0.0),
                             Limits::denorm_min()};
  Rays<T> rays = any_rays<T>(3, count, seed + 1);
  for (Ray<T>& ray : rays)
    for (T* number : {&ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.direction.x, &ray.direction.y})
      if (random.below(6) == 0) *number = odd[static_cast<std::size_t>(random.below(8))];
  return rays;
}

}  // namespace orrery::test
