#pragma once

#include <array>

#include "core/math/lane_vectors.h"
#include "core/math/products.h"

namespace orrery {

namespace detail {

// The exact difference b - a as a rounded value `high` plus its rounding error `low` (Knuth's TwoSum).
template <class N>
struct ExactDifference {
  N high, low;
  ExactDifference(const N& b, const N& a) : high(b - a) {
    const N back = high - b;
    low = (b - (high - back)) - (a + back);
  }
};

}  // namespace detail

// Returns a triangle's unit normal by the right-hand rule, or 0 if its area is 0. Accurate even for thin
// triangles with two long, nearly parallel sides, because side vectors are computed exactly and products
// nearly exactly.
template <class N>
inline Vec3<N> face_normal(const Vec3<N>& a, const Vec3<N>& b, const Vec3<N>& c) {
  using Difference = detail::ExactDifference<N>;
  const std::array<Difference, 3> e{Difference(b.x, a.x), Difference(b.y, a.y), Difference(b.z, a.z)};
  const std::array<Difference, 3> f{Difference(c.x, a.x), Difference(c.y, a.y), Difference(c.z, a.z)};
  const auto part = [&](std::size_t i, std::size_t j) -> N {
    return difference_of_products(e[i].high, f[j].high, e[j].high, f[i].high) +
           ((e[i].high * f[j].low - e[j].high * f[i].low) + (e[i].low * f[j].high - e[j].low * f[i].high));
  };
  return safe_normalize(Vec3<N>(part(1, 2), part(2, 0), part(0, 1)));
}

}  // namespace orrery
