#pragma once

#include "core/math/hemisphere.h"

// Phase function of Henyey and Greenstein ("Diffuse radiation in the galaxy", Astrophysical Journal 93,
// 1941). `g` is the mean cosine of the angle between the directions before and after scattering, -1 < g < 1.
namespace orrery {

// Returns the cosine whose cumulative probability is u, for u in [0, 1). The usual formula is expanded and
// divided by g, so that it is also accurate near g = 0.
template <class N>
[[gnu::always_inline]] inline N henyey_greenstein_cosine(const N& g, const N& u) {
  using T = ScalarOf<N>;
  const N one(T(1)), s = u + u - one, s2 = s * s, q = one + g * s;
  const N above = s + g * (N(T(0.5)) * (s2 + T(3)) + g * (s + g * (N(T(0.5)) * (s2 - one))));
  return min_first(one, max_first(N(-one), N(above / (q * q))));
}

// Returns the unit direction after scattering, from u and v in [0, 1). REQUIRES: `direction` is unit.
template <class N>
[[gnu::always_inline]] inline Vec3<N> henyey_greenstein_direction(const Vec3<N>& direction, const N& g,
                                                                  const N& u, const N& v) {
  using std::sqrt;
  using T = ScalarOf<N>;
  const N along = henyey_greenstein_cosine(g, u), zero(T(0)), one(T(1));
  const N across = sqrt(max_first(zero, N((one - along) * (one + along))));
  const auto [sine, cosine] = sine_cosine_turns(v);
  const Tangents<N> basis = tangents_of(direction);
  return normalize(basis.first * (across * cosine) + basis.second * (across * sine) + direction * along);
}

}  // namespace orrery
