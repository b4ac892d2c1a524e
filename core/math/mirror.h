#pragma once

#include "core/math/vec3.h"

namespace orrery {

// `direction` mirrored about the shading normal, or about the true one where the former would send it into
// the surface. All unit; the normals stand on the side that `direction` comes from.
template <class N>
[[gnu::always_inline]] inline Vec3<N> mirrored(const Vec3<N>& direction, const Vec3<N>& normal,
                                               const Vec3<N>& true_normal) {
  using T = ScalarOf<N>;
  const auto about = [&](const Vec3<N>& n) { return direction - n * (T(2) * dot(direction, n)); };
  const Vec3<N> r = about(normal);
  const auto sinks = !(dot(r, true_normal) > N(T(0)));
  if (!any(sinks)) return r;
  const Vec3<N> safe = about(true_normal);
  return select(sinks, safe, r);
}

}  // namespace orrery
