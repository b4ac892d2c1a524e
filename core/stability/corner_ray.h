#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/bounds.h"
#include "core/stability/split_mix.h"

namespace orrery {

// Axis-aligned box, and a ray that is tested against the box.
template <class N>
struct BoxTest {
  Vec3<N> lo, hi, origin, direction;

  // Moves ray and box so that the ray's origin is 0. Otherwise, the padding of the slab test for the rounding
  // of the origin could hide errors. REQUIRES: lo - origin and hi - origin are exact.
  void start_from_zero() {
    lo = lo - origin;
    hi = hi - origin;
    origin = {};
  }

  MaskOf<N> enters_it() const {
    using T = ScalarOf<N>;
    return enters(BoxRay<N>(origin, direction), lo, hi, N(std::numeric_limits<T>::infinity()));
  }
};

// Returns a flat box and a ray that hits a corner of the box exactly, at a distance t that is a power of two.
// All coordinates are integer multiples of `unit`, small enough that corner - origin is exact.
template <class T>
BoxTest<T> ray_through_a_corner(SplitMix& random, T unit) {
  constexpr int kBits = std::numeric_limits<T>::digits - 2;
  const auto whole = [&](std::int64_t below) {
    return static_cast<T>(random.bits() % static_cast<std::uint64_t>(below));
  };
  const auto place = [&] {
    return (whole(std::int64_t{1} << kBits) - static_cast<T>(std::int64_t{1} << (kBits - 1))) * unit;
  };
  const auto extent = [&] { return (T(1) + whole(4096)) * unit; };
  BoxTest<T> b;
  b.lo = {place(), place(), place()};
  b.hi = {b.lo.x + extent(), b.lo.y + extent(), b.lo.z + extent()};
  const int flat = random.below(3);
  if (flat == 0) b.hi.x = b.lo.x;
  if (flat == 1) b.hi.y = b.lo.y;
  if (flat == 2) b.hi.z = b.lo.z;
  const Vec3<T> corner(random.below(2) ? b.lo.x : b.hi.x, random.below(2) ? b.lo.y : b.hi.y,
                       random.below(2) ? b.lo.z : b.hi.z);
  b.origin = {place(), place(), place()};
  b.direction = (corner - b.origin) * std::ldexp(T(1), -random.below(61));
  b.start_from_zero();
  return b;
}

}  // namespace orrery
