#pragma once

#include "core/math/vec3.h"

namespace orrery {

// Reflects `direction` about a unit normal.
template <class N>
[[gnu::always_inline]] inline Vec3<N> mirrored(const Vec3<N>& direction, const Vec3<N>& normal) {
  return direction - normal * (ScalarOf<N>(2) * dot(direction, normal));
}

// Reflects `direction` about the shading normal `normal`, or about the geometric normal `true_normal` if the
// result would point into the surface. REQUIRES: all vectors are unit, and both normals point to the side
// that `direction` comes from.
template <class N>
[[gnu::always_inline]] inline Vec3<N> mirrored(const Vec3<N>& direction, const Vec3<N>& normal,
                                               const Vec3<N>& true_normal) {
  using T = ScalarOf<N>;
  const Vec3<N> r = mirrored(direction, normal);
  const auto sinks = !(dot(r, true_normal) > N(T(0)));
  if (!any(sinks)) return r;
  const Vec3<N> safe = mirrored(direction, true_normal);
  return select(sinks, safe, r);
}

}  // namespace orrery
