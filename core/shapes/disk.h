#pragma once

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"
#include "core/shapes/round_hull.h"

namespace orrery {

template <class N>
struct Disk {
  Vec3<N> center, normal;
  N radius;
  N magnitude;  // upper bound of the absolute coordinates

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false};

  static void read(Params& p, std::vector<Disk<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return Boundsd::around(center, round_reach(normal) * radius); }

  std::vector<HullTriangle> hull() const {
    return round_hull(Vec3d(center), Vec3d(normal), double(radius), 0);
  }

  Patch patch() const {
    const Tangents<double> axes = tangents_of(normal);
    return {Patch::Kind::disk, center, axes.first * radius, axes.second * radius};
  }

  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    const N t = dot(center - ray.origin, normal) / dot(ray.direction, normal);
    const Vec3<N> from_center = ray.at(t) - center;
    const auto inside = dot(from_center, from_center) <= radius * radius;
    return select(t > N(T(0)) && inside, t, N(std::numeric_limits<T>::infinity()));
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> near = ray.at(t);
    return {near - normal * dot(near - center, normal), normal, normal, magnitude};
  }

  // u is the angle around the normal in turns, in [0, 1], anticlockwise as seen from the front. v is 0 at the
  // centre and 1 at the edge.
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    using T = ScalarOf<N>;
    const Tangents<N> axes = tangents_of(normal);
    const Vec3<N> from = position - center;
    const N x = dot(from, axes.first), y = dot(from, axes.second), distance = length(from);
    const N u = positive_turns(x, y), v = distance / radius;
    const auto middle = !(distance > N(T(0)));
    const Vec3<N> around = axes.second * (x / distance) - axes.first * (y / distance);
    return {u, v, u, v, select(middle, axes.second, around)};
  }
};

}  // namespace orrery
