#pragma once

#include <numbers>

#include "core/math/elementary.h"

namespace orrery {

// Returns the mean of cos(2 pi x) over an interval of length `width` around x: cos(2 pi x) sin(pi w) / (pi
// w).
template <class N>
[[gnu::always_inline]] inline N mean_cosine(const N& x, const N& width) {
  using T = ScalarOf<N>;
  using std::floor;
  const N zero(T(0)), one(T(1)), half_turns = width * T(0.5);
  const auto wide = width > zero;
  const N sine = sine_cosine_turns(half_turns).sine;
  const N share = select(wide, N(sine / (std::numbers::pi_v<T> * select(wide, width, one))), one);
  return sine_cosine_turns(N(x - floor(x))).cosine * share;
}

}  // namespace orrery
