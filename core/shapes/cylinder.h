#pragma once

#include <optional>

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"
#include "core/shapes/round_hull.h"

namespace orrery {

// Cylinder, with caps or infinitely long.
template <class N>
struct Cylinder {
  Vec3<N> center, axis;  // the axis is a unit vector
  N radius;
  N half_length;  // infinite for an infinite cylinder
  N magnitude;    // upper bound of the absolute coordinates; if infinite: within `radius` of `center`

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = true};

  static void read(Params& p, std::vector<Cylinder<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const {
    if (std::isinf(half_length)) return Boundsd::everything();
    return Boundsd::around(center, abs(axis) * half_length + round_reach(axis) * radius);
  }

  Vec3d anchor() const { return center; }
  double min_distance(const Vec3d& from) const {
    return std::abs(length(cross(from - center, axis)) - radius);
  }

  std::optional<Patch> patch() const {
    if (std::isinf(half_length)) return {};
    const Tangents<double> across = tangents_of(axis);
    return Patch{Patch::Kind::cylinder, center, across.first * radius, across.second * radius,
                 axis * half_length};
  }

  std::vector<HullTriangle> hull() const {
    return round_hull(Vec3d(center), Vec3d(axis), double(radius), double(half_length));
  }

  // Returns the distance to the point where the ray enters the cylinder, or leaves it if the origin is
  // inside. Returns infinity for a miss. The cylinder is the intersection of an infinite cylinder and the
  // slab between the caps. The roots of the infinite cylinder are computed as in Ball::distance(), in the
  // plane perpendicular to the axis.
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    using std::signbit;
    using std::sqrt;
    const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
    const Vec3<N> f = ray.origin - center;
    const N along_f = dot(f, axis), along_d = dot(ray.direction, axis);
    const Vec3<N> f_across = f - axis * along_f, d_across = ray.direction - axis * along_d;
    const N a = dot(d_across, d_across);
    const auto parallel = a == zero;
    const N b = -dot(f_across, d_across);
    const Vec3<N> residue = f_across + d_across * select(parallel, zero, N(b / a));
    const N discriminant = radius * radius - dot(residue, residue);
    const auto meets = discriminant >= zero;
    if (!any(meets)) return infinity;
    const N root = sqrt(a * select(meets, discriminant, zero));
    const N q = b + select(b < zero, -root, root);
    const N from_axis = length(f_across);
    const N t0 = (from_axis - radius) * (from_axis + radius) / q, t1 = q / a;
    const auto inverted = signbit(along_d);
    const N near_cap = (select(inverted, half_length, -half_length) - along_f) / along_d;
    const N far_cap = (select(inverted, -half_length, half_length) - along_f) / along_d;
    const N enter = max_first(select(parallel, -infinity, min_first(t0, t1)), near_cap);
    const N leave = min_first(select(parallel, infinity, max_first(t0, t1)), far_cap);
    const N t = select(enter > zero, enter, leave);
    return select(meets && enter <= leave && t > zero && t < infinity, t, infinity);
  }

  // Returns the surface of the wall or of a cap, whichever is nearer to the ray's point at `t`.
  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    using T = ScalarOf<N>;
    using std::abs;
    using std::max;
    const Vec3<N> from_center = ray.at(t) - center;
    const N along = dot(from_center, axis);
    const Vec3<N> across = from_center - axis * along;
    const N from_axis = length(across);
    const auto cap = abs(half_length - abs(along)) < abs(radius - from_axis);
    const N cap_side = select(along > N(T(0)), N(T(1)), N(T(-1)));
    const Vec3<N> outward = across * select(cap, N(T(0)), N(T(1) / from_axis));
    const N cap_along = select(cap, cap_side, N(T(0)));
    const Vec3<N> normal = outward + axis * cap_along;
    const Vec3<N> on_wall = center + axis * along + outward * radius;
    const Vec3<N> on_cap = center + across + axis * (cap_side * half_length);
    const Vec3<N> position = select(cap, on_cap, on_wall);
    return {position, normal, normal, max(magnitude, max_component(orrery::abs(position)))};
  }

  // u is the angle around the axis in turns, in [0, 1], anticlockwise as seen from the tip of `axis`. v on
  // the wall is 0 at the base and 1 at the top. On an infinite cylinder, v is the distance along the axis
  // from `center`, in metres. v on a cap is 0 at the centre and 1 at the edge.
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    using T = ScalarOf<N>;
    using std::abs;
    const Tangents<N> axes = tangents_of(axis);
    const Vec3<N> from = position - center;
    const N along = dot(from, axis), x = dot(from, axes.first), y = dot(from, axes.second);
    const N from_axis = length(from - axis * along), infinity(std::numeric_limits<T>::infinity());
    const auto cap = abs(half_length - abs(along)) < abs(radius - from_axis);
    const N wall = select(half_length < infinity, N((along / half_length + T(1)) * T(0.5)), along);
    const N u = positive_turns(x, y), v = select(cap, N(from_axis / radius), wall);
    const auto middle = !(from_axis > N(T(0)));
    const Vec3<N> around = axes.second * (x / from_axis) - axes.first * (y / from_axis);
    return {u, v, u, v, select(middle, axes.second, around)};
  }
};

}  // namespace orrery
