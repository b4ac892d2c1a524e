#pragma once

#include <array>

#include "core/math/elementary.h"

namespace orrery {

// Albedo as a function of a cosine mu in [0, 1]: a Chebyshev series in s = (1 + c) mu / (c + mu). The scale c
// is about the width in mu of the steepest part of the albedo, usually the GGX alpha. The albedo is then a
// smooth function of s.
template <class N, std::size_t kTerms>
struct AlbedoSeries {
  std::array<N, kTerms> coefficients;
  N scale;
  N mean;  // cosine-weighted mean over the hemisphere: the integral of 2 mu E(mu)

  // Returns the series at `mu`, clamped to [0, 1]. Uses Clenshaw's recurrence.
  [[gnu::always_inline]] N at(const N& mu) const {
    using T = ScalarOf<N>;
    const N s = (T(1) + scale) * mu / (scale + mu);
    const N x = T(2) * s - T(1), x2 = T(2) * x;
    N next(T(0)), after(T(0));
#pragma GCC unroll 32
    for (std::size_t k = kTerms - 1; k >= 1; --k) {
      const N b = x2 * next - after + coefficients[k];
      after = next;
      next = b;
    }
    return min_first(N(T(1)), max_first(N(T(0)), N(x * next - after + coefficients[0])));
  }
};

// Returns the Chebyshev polynomial of degree j at the k-th of `terms` Chebyshev nodes.
inline double chebyshev_cosine(std::size_t terms, std::size_t j, std::size_t k) {
  return sine_cosine_turns(static_cast<double>(j * (2 * k + 1)) / (4.0 * static_cast<double>(terms))).cosine;
}
// Returns the cosine mu of interpolation node k.
template <std::size_t kTerms>
double series_node(double scale, std::size_t k) {
  const double s = (1 + chebyshev_cosine(kTerms, 1, k)) / 2;
  return scale * s / (1 + scale - s);
}

// Returns the series that interpolates `values` at the cosines series_node(scale, k).
template <std::size_t kTerms>
AlbedoSeries<double, kTerms> series_through(const std::array<double, kTerms>& values, double scale) {
  AlbedoSeries<double, kTerms> series{{}, scale, 0};
  for (std::size_t j = 0; j < kTerms; ++j) {
    for (std::size_t k = 0; k < kTerms; ++k)
      series.coefficients[j] += values[k] * chebyshev_cosine(kTerms, j, k);
    series.coefficients[j] *= (j == 0 ? 1.0 : 2.0) / kTerms;
  }
  constexpr int kSteps = 1024;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    series.mean += 2 * mu * series.at(mu) / kSteps;
  }
  return series;
}

}  // namespace orrery
