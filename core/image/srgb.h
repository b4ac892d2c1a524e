#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "core/math/decode_srgb.h"
#include "core/math/lanes.h"

// Transfer function of sRGB (IEC 61966-2-1), for a scalar or lanes.
namespace orrery {
namespace srgb {

// Largest linear value of the linear segment.
inline constexpr double kEndOfLine = 0.0031308;

// Polynomial in x^(1/4) that approximates 1.055 x^(1/2.4) - 0.055 for x from kEndOfLine to 1. It interpolates
// at Chebyshev points. The error is below 0.0006 / 255.
inline constexpr std::array kCurve = {-0.059739011f, 0.14195826f,  1.3545726f,  -0.82528002f,
                                      0.62100228f,   -0.29424764f, 0.061734308f};

template <class N>
[[gnu::always_inline]] inline N curve(const N& x) {
  using std::sqrt;
  const N t = sqrt(sqrt(x));
  N value = kCurve.back();
  [&]<std::size_t... k>(std::index_sequence<k...>) {  // unrolled
    ((value = value * t + N(kCurve[kCurve.size() - 2 - k])), ...);
  }
  (std::make_index_sequence<kCurve.size() - 1>());
  return value;
}

}  // namespace srgb

// Encodes a linear value as sRGB in [0, 1], with an error below 3e-6. Clamps the linear value to [0, 1]. NaN
// gives 0.
template <class N>
[[gnu::always_inline]] inline N encode_srgb(const N& linear) {
  using Scalar = ScalarOf<N>;
  const N x = min_first(N(Scalar(1)), max_first(N(Scalar(0)), linear));
  return select(x <= N(static_cast<Scalar>(srgb::kEndOfLine)), x * N(static_cast<Scalar>(12.92)),
                srgb::curve(x));
}

}  // namespace orrery
