#pragma once

#include "core/math/lanes.h"

namespace orrery {

// Real roots in ascending order. A single real root is stored three times.
template <class N>
struct CubicRoots {
  N low, middle, high;
};

// Returns the real roots of x^3 + p x + q. The error is a few epsilon times max(1, sqrt|p|, cbrt|q|), or the
// square root of epsilon near a double root. Newton's iteration finds the root of the largest magnitude from
// above. The product and the sum of the other two roots follow from it without cancellation.
template <class N>
[[gnu::always_inline]] inline CubicRoots<N> depressed_cubic_roots(const N& p, const N& q) {
  using T = ScalarOf<N>;
  using std::abs;
  using std::signbit;
  using std::sqrt;
  constexpr T kEpsilon = std::numeric_limits<T>::epsilon();
  constexpr int kMaxSteps = 40;
  const N zero(T(0)), size = abs(q);
  // An upper bound of the cube root for sizes from 1e-13 to 1e7: 1/4 + 1/16 + 1/64 is nearly 1/3.
  const auto above_cbrt = [](const N& x) {
    const N quarter = sqrt(sqrt(x)), sixteenth = sqrt(sqrt(quarter)), rest = sqrt(sqrt(sixteenth));
    return quarter * sixteenth * rest * T(1.2);
  };
  const auto falls = p < zero;  // between extrema at -+ tops / 2
  // -y is a root of x^3 + p x + |q|, the one of the largest magnitude.
  const N tops = T(2) * sqrt(select(falls, N(-p / T(3)), zero));
  N y =
      select(falls, max_first(tops, above_cbrt(T(4) * size)), min_first(above_cbrt(size), N(size / abs(p))));
  auto active = y > zero;
  for (int step = 0; step < kMaxSteps && any(active); ++step) {
    const N change = ((y * y + p) * y - size) / (T(3) * y * y + p);
    y = select(active, N(y - change), y);
    active = active && abs(change) > T(2) * kEpsilon * max_first(N(T(1)), y);
  }
  const N discriminant = T(-3) * y * y - T(4) * p;
  const auto three = discriminant > zero;
  const N high = select(three, N((y + sqrt(select(three, discriminant, zero))) * T(0.5)), N(-y));
  const N middle = select(three, N(size / (y * high)), N(-y));
  const auto mirrored = signbit(q);
  return {select(mirrored, N(-high), N(-y)), select(mirrored, N(-middle), middle), select(mirrored, y, high)};
}

}  // namespace orrery
