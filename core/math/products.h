#pragma once

#include <cmath>

#include "core/math/lanes.h"

// Products with known rounding errors. Results have the same bits at every instruction level, with or without
// FMA.
namespace orrery {

namespace detail {

// Returns the upper 26 bits of the mantissa of `x` (Veltkamp's splitting).
inline double high_half(double x) {
  const double scaled = 134217729 * x;  // 2^27 + 1
  return scaled - (scaled - x);
}

}  // namespace detail

// Returns a * b - p exactly, where p is a * b rounded. Without FMA, follows Dekker, "A floating-point
// technique for extending the available precision", 1971. REQUIRES: neither p nor the result underflows, and
// |a|, |b| and |p| are below 2^996 (double).
inline float product_error(float a, float b, float p) {
  return static_cast<float>(static_cast<double>(a) * static_cast<double>(b) - static_cast<double>(p));
}
inline double product_error(double a, double b, double p) {
#if defined(__FMA__)
  return std::fma(a, b, -p);
#else
  const double a1 = detail::high_half(a), b1 = detail::high_half(b), a2 = a - a1, b2 = b - b1;
  return ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2;
#endif
}
inline long double product_error(long double a, long double b, long double p) { return std::fma(a, b, -p); }
template <class T, class Abi>
[[gnu::always_inline]] inline stdx::simd<T, Abi> product_error(const stdx::simd<T, Abi>& a,
                                                               const stdx::simd<T, Abi>& b,
                                                               const stdx::simd<T, Abi>& p) {
  using N = stdx::simd<T, Abi>;
#if defined(__FMA__)
  if constexpr (registers::kFits<T, N>) return multiply_subtract(a, b, p);
#endif
  return N([&](auto i) { return product_error(a[i], b[i], p[i]); });
}

// Returns a * b - c * d within two roundings of the exact value. The result is 0 or has the sign of the exact
// value. Exchanging the two products negates the result exactly.
template <class N>
[[gnu::always_inline]] inline N difference_of_products(const N& a, const N& b, const N& c, const N& d) {
  const N ab = a * b, cd = c * d;
  return (ab - cd) + (product_error(a, b, ab) - product_error(c, d, cd));
}

}  // namespace orrery
