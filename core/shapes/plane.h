#pragma once

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"

namespace orrery {

// Infinite plane.
template <class N>
struct Plane {
  Vec3<N> point, normal;

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false, .half_space = true};

  static void read(Params& p, std::vector<Plane<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return Boundsd::everything(); }
  Vec3d anchor() const { return point; }
  OccupiedSpace::Plane plane() const { return {point, normal}; }
  double min_distance(const Vec3d& from) const { return std::abs(dot(from - point, normal)); }

  // Returns infinity for a miss. The quotient of a parallel ray is infinite or NaN, and counts as a miss.
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    const N t = dot(point - ray.origin, normal) / dot(ray.direction, normal);
    return select(t > N(T(0)), t, N(std::numeric_limits<T>::infinity()));
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> near = ray.at(t);
    const Vec3<N> position = near - normal * dot(near - point, normal);
    using std::max;
    return {position, normal, normal, max(max_component(abs(position)), max_component(abs(point)))};
  }

  // u and v are the distances from `point` along two perpendicular axes of the plane, in metres.
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    const Tangents<N> axes = tangents_of(normal);
    const Vec3<N> from = position - point;
    const N u = dot(from, axes.first), v = dot(from, axes.second);
    return {u, v, u, v, axes.first};
  }
};

}  // namespace orrery
