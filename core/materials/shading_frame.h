#pragma once

#include "core/math/hemisphere.h"

namespace orrery {

// Coordinate frame whose third axis is the shading normal, or the geometric normal if the shading normal
// faces away from the viewer.
template <class N>
struct ShadingFrame {
  Vec3<N> normal;
  Tangents<N> tangents;

  ShadingFrame(const Vec3<N>& shading, const Vec3<N>& geometric, const Vec3<N>& viewer)
      : normal(facing(shading, geometric, viewer)), tangents(tangents_of(normal)) {}

  [[gnu::always_inline]] Vec3<N> local(const Vec3<N>& v) const {
    return {dot(tangents.first, v), dot(tangents.second, v), dot(normal, v)};
  }
  [[gnu::always_inline]] Vec3<N> world(const Vec3<N>& v) const {
    return tangents.first * v.x + tangents.second * v.y + normal * v.z;
  }

 private:
  static Vec3<N> facing(const Vec3<N>& shading, const Vec3<N>& geometric, const Vec3<N>& viewer) {
    return select(dot(shading, viewer) > N(ScalarOf<N>(0)), shading, geometric);
  }
};

}  // namespace orrery
