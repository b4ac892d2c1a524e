#pragma once

#include "core/math/vec3.h"

namespace orrery {

// Returns the unit vectors along the lanes of `a`, equal to those of safe_normalize() of scalar vectors.
template <class T, class Abi>
[[gnu::always_inline]] inline Vec3<stdx::simd<T, Abi>> safe_normalize(const Vec3<stdx::simd<T, Abi>>& a) {
  using N = stdx::simd<T, Abi>;
  const N largest = max_component(abs(a)), zero(T(0));
  const Vec3<N> scaled = a / select(largest > zero, largest, N(T(1)));
  return select(largest > zero, scaled / length(scaled), Vec3<N>(zero));
}

// Converts the components of a vector to another number type of equal width.
template <class To, class From>
[[gnu::always_inline]] inline Vec3<To> convert_vector(const Vec3<From>& v) {
  return {convert_to<To>(v.x), convert_to<To>(v.y), convert_to<To>(v.z)};
}

}  // namespace orrery
