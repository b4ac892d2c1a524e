#pragma once

#include "core/math/bounds.h"
#include "core/model/shape.h"

namespace orrery {

template <class N>
struct Rectangle {
  Vec3<N> corner, a, b;          // a corner and two perpendicular sides
  Vec3<N> per_a, per_b, normal;  // a / |a|^2, b / |b|^2, unit normal
  N magnitude;                   // largest absolute coordinate

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = false};

  static void read(Params& p, std::vector<Rectangle<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return Boundsd::of({corner, corner + a, corner + b, corner + a + b}); }
  std::vector<HullTriangle> hull() const {
    const Vec3d at(corner), far_a(corner + a), far_b(corner + b), far(corner + a + b);
    return {{at, far_a, far}, {at, far, far_b}};
  }
  Patch patch() const { return {Patch::Kind::rectangle, corner, a, b}; }

  // Coordinates of a point along `a` and `b`, as multiples of their lengths. In [0, 1] inside the rectangle.
  struct Shares {
    N u, v;
  };
  Shares shares(const Vec3<N>& at) const {
    const Vec3<N> from = at - corner;
    return {dot(from, per_a), dot(from, per_b)};
  }

  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    const N t = dot(corner - ray.origin, normal) / dot(ray.direction, normal), zero(T(0)), one(T(1));
    const auto [u, v] = shares(ray.at(t));
    const auto inside = u >= zero && u <= one && v >= zero && v <= one;
    return select(t > zero && inside, t, N(std::numeric_limits<T>::infinity()));
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> near = ray.at(t);
    return {near - normal * dot(near - corner, normal), normal, normal, magnitude};
  }

  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    const auto [u, v] = shares(position);
    return {u, v, u, v, normalize(a)};
  }
};

}  // namespace orrery
