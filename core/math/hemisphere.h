#pragma once

#include <numbers>

#include "core/math/elementary.h"
#include "core/math/vec3.h"

// Hemisphere sampling and orthonormal bases.
namespace orrery {

// Two unit vectors perpendicular to the unit vector n and to each other. Discontinuous only where n.z changes
// sign (Duff, Burgess, Christensen, Hery, Kensler, Liani, Villemin, "Building an Orthonormal Basis,
// Revisited", JCGT 2017).
template <class N>
struct Tangents {
  Vec3<N> first, second;
};
template <class N>
[[gnu::always_inline]] inline Tangents<N> tangents_of(const Vec3<N>& n) {
  using T = ScalarOf<N>;
  using std::signbit;
  const N one(T(1)), sign = select(signbit(n.z), N(-one), one);
  const N a = N(T(-1)) / (sign + n.z), b = n.x * n.y * a;
  return {{one + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

// Returns the density of cosine_direction() per solid angle, for a direction with this cosine to the normal.
template <class N>
[[gnu::always_inline]] inline N cosine_pdf(const N& cosine) {
  using T = ScalarOf<N>;
  return cosine * (T(1) / std::numbers::pi_v<T>);
}

// Samples a direction about `normal` with density proportional to the cosine of the angle between them, from
// u and v in [0, 1). Projects a uniform point of the unit disk onto the hemisphere (Malley's method).
template <class N>
[[gnu::always_inline]] inline Vec3<N> cosine_direction(const Vec3<N>& normal, const N& u, const N& v) {
  using std::sqrt;
  using T = ScalarOf<N>;
  const N radius = sqrt(u), height = sqrt(max_first(N(T(0)), N(T(1) - u)));
  const auto [sine, cosine] = sine_cosine_turns(v);
  const Tangents<N> basis = tangents_of(normal);
  return basis.first * (radius * cosine) + basis.second * (radius * sine) + normal * height;
}

}  // namespace orrery
