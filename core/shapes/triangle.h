#pragma once

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"
#include "core/shapes/triangle_hit.h"

namespace orrery {

// Single triangle, not part of a mesh.
template <class N>
struct Triangle {
  Corners<N> corners;
  Vec3<N> normal;  // by the right-hand rule over a, b, c
  N magnitude;     // largest absolute coordinate

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false};

  static void read(Params& p, std::vector<Triangle<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return corners.bounds(); }
  std::vector<HullTriangle> hull() const { return corners.hull(); }
  Patch patch() const { return patch_of(corners); }

  using Core = Corners<N>;
  const Core& core() const { return corners; }
  N distance(const Ray<N>& ray) const { return corners.distance(ray); }

  Surface<N> surface(const Ray<N>& ray, const N&) const {
    return {corners.mix(corners.weights(ray)), normal, normal, magnitude};
  }

  // u and v are the barycentric weights of the second and third vertex.
  SurfacePoint<N> parameters(const Ray<N>& ray, const Vec3<N>&) const {
    const Vec3<N> weights = corners.weights(ray);
    return {weights.y, weights.z, weights.y, weights.z, normalize(corners.b - corners.a)};
  }
};

}  // namespace orrery
