#pragma once

#include "core/textures/texture_of.h"

namespace orrery {

// Cells of side 1 in two colours. A cell is even if the sum of the integer parts of its coordinates is even.
template <class N>
struct Checker {
  Vec3<N> even, odd;

  TextureBounds bounds() const { return bounds_of_mix(even, odd); }
  double detail() const { return 1; }

  // Returns the exact mean over the box of sides `width` around `at`. The sign of a cell is a product of one
  // sign per coordinate, so the mean over the box is the product of the means over its sides.
  Vec3<N> value(const Vec3<N>& at, const Vec3<N>& width) const {
    using T = ScalarOf<N>;
    const N sign = mean_sign(at.x, width.x) * mean_sign(at.y, width.y) * mean_sign(at.z, width.z);
    return mix_colors(odd, even, N(T(0.5) + T(0.5) * sign));
  }

  // Returns the mean of (-1)^floor(x) over an interval of length `width` around x. The integral from 0 to x
  // is the distance of x from the nearest even integer. Within one cell the mean is a sign, which avoids the
  // cancellation of the integral for short intervals.
  [[gnu::always_inline]] static N mean_sign(const N& x, const N& width) {
    using T = ScalarOf<N>;
    using std::floor;
    const N one(T(1)), from = x - width * T(0.5), to = x + width * T(0.5);
    const N first = floor(from), last = floor(to);
    const auto within = first == last;
    const N sign = one - T(2) * (first - T(2) * floor(first * T(0.5)));
    if (all(within)) return sign;
    const N mean = (to_even(to) - to_even(from)) / select(within, one, width);
    return select(within, sign, min_first(one, max_first(N(-one), mean)));
  }

 private:
  // Returns the distance of x from the nearest even integer.
  [[gnu::always_inline]] static N to_even(const N& x) {
    using T = ScalarOf<N>;
    using std::abs;
    using std::floor;
    return abs(x - T(2) * floor(x * T(0.5) + T(0.5)));
  }
};

}  // namespace orrery
