#pragma once

#include <array>

#include "core/math/lanes.h"

namespace orrery {

// Albedo E(mu) of GGX microfacets of one alpha that mirror all light once: the share of light at a cosine mu
// that they reflect without passing it on to each other. A Chebyshev series in
// s = (1 + alpha) mu / (alpha + mu), in which E is smooth for every alpha: within 1e-3 (mu > 0.01).
template <class N>
struct GgxAlbedo {
  static constexpr std::size_t kTerms = 14;
  std::array<N, kTerms> coefficients;
  N alpha;
  N mean;  // over the hemisphere: the integral of 2 mu E(mu)

  // By Clenshaw's recurrence.
  [[gnu::always_inline]] N at(const N& mu) const {
    using T = ScalarOf<N>;
    const N s = (T(1) + alpha) * mu / (alpha + mu);
    const N x = T(2) * s - T(1), x2 = T(2) * x;
    N next(T(0)), after(T(0));
#pragma GCC unroll 16
    for (std::size_t k = kTerms - 1; k >= 1; --k) {
      const N b = x2 * next - after + coefficients[k];
      after = next;
      next = b;
    }
    return min_first(N(T(1)), max_first(N(T(0)), N(x * next - after + coefficients[0])));
  }
};

// By interpolation in a table made once by quadrature. REQUIRES: 0 < alpha <= 1.
GgxAlbedo<double> ggx_albedo(double alpha);

}  // namespace orrery
