#pragma once

#include <algorithm>

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"
#include "core/shapes/round_hull.h"

namespace orrery {

// Right circular cone or frustum with caps. The radius is linear along the axis.
template <class N>
struct Cone {
  Vec3<N> center, axis;  // the axis is a unit vector from the base to the top
  N radius;              // at the centre
  N half_length;
  N slope;      // growth of the radius per metre along the axis
  N cosine;     // cosine of the angle between the wall and the axis
  N magnitude;  // upper bound of the absolute coordinates

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = true};

  static void read(Params& p, std::vector<Cone<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  // A cone is the convex hull of its caps.
  Boundsd bounds() const {
    const Vec3d half = axis * half_length, reach = round_reach(axis);
    Boundsd box = Boundsd::around(center - half, reach * std::max(0.0, radius - slope * half_length));
    box.include(Boundsd::around(center + half, reach * std::max(0.0, radius + slope * half_length)));
    return box;
  }

  std::vector<HullTriangle> hull() const {
    return round_hull(Vec3d(center), Vec3d(axis), double(radius + std::abs(slope) * half_length),
                      double(half_length));
  }

  // Returns the distance to the point where the ray enters the cone, or leaves it if the origin is inside.
  // Returns infinity for a miss. The cone is the intersection of the slab between the caps and one half of a
  // double cone.
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    using std::signbit;
    const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
    const Vec3<N> f = ray.origin - center;
    const N along_f = dot(f, axis), along_d = dot(ray.direction, axis);
    const auto inverted = signbit(along_d);
    const Span slab{(select(inverted, half_length, -half_length) - along_f) / along_d,
                    (select(inverted, -half_length, half_length) - along_f) / along_d};
    const Span wall = wall_of(f, ray.direction, along_d, slab);
    const N enter = max_first(wall.enter, slab.enter), leave = min_first(wall.leave, slab.leave);
    const N t = select(enter > zero, enter, leave);
    return select(enter <= leave && t > zero && t < infinity, t, infinity);
  }

  // Returns the surface of the wall or of a cap, whichever is nearer to the ray's point at `t`. The normal at
  // the tip is that of a cap.
  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    using T = ScalarOf<N>;
    const Vec3<N> from = ray.at(t) - center;
    const N along = dot(from, axis);
    const Vec3<N> near_across = from - axis * along;
    const Vec3<N> across =
        near_across - axis * dot(near_across, axis);  // again: near the tip, what remains is small
    const N from_axis = length(across), to_wall = distance_to_wall(along, from_axis), zero(T(0));
    const auto cap = is_on_cap(along, to_wall) || !(from_axis > zero);
    const N end = select(along > zero, half_length, -half_length), end_side = end / half_length;
    const Vec3<N> outward = across * select(cap, zero, N(cosine / from_axis));
    const Vec3<N> normal = outward + axis * select(cap, end_side, N(-slope * cosine));
    const N on_wall = max_first(-half_length, min_first(half_length, N(along + slope * cosine * to_wall)));
    const N height = select(cap, end, on_wall), rho = max_first(zero, N(radius + slope * height));
    const N scale = select(cap && rho >= from_axis, N(T(1)), N(rho / from_axis));
    return {center + (axis * height + across * scale), normal, normal, magnitude};
  }

  // u is the angle around the axis in turns, in [0, 1], anticlockwise as seen from the tip of `axis`. v on
  // the wall is 0 at the base and 1 at the top. v on a cap is 0 at the centre and 1 at the edge.
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const Tangents<N> axes = tangents_of(axis);
    const Vec3<N> from = position - center;
    const N along = dot(from, axis), x = dot(from, axes.first), y = dot(from, axes.second);
    const N from_axis = sqrt(x * x + y * y), zero(T(0));
    const auto cap = is_on_cap(along, distance_to_wall(along, from_axis));
    const N edge = radius + slope * select(along > zero, half_length, -half_length);
    const N on_cap = select(edge > zero, N(from_axis / edge), zero);
    const N u = positive_turns(x, y), v = select(cap, on_cap, N((along / half_length + T(1)) * T(0.5)));
    const auto middle = !(from_axis > zero);
    const Vec3<N> around = axes.second * (x / from_axis) - axes.first * (y / from_axis);
    return {u, v, u, v, select(middle, axes.second, around)};
  }

 private:
  // Part of a ray. Infinite where there is no end. Empty if enter > leave or NaN.
  struct Span {
    N enter, leave;
  };

  // Returns the part of the ray in the half of the double cone that contains the cone. `f` is the origin
  // relative to the centre, `slab` the part between the planes of the caps. With rho the radius at the height
  // of a point, the double cone is |across|^2 <= rho^2. Along the ray, this is an inequality
  // a s^2 - 2 b s + c <= 0. For rays along a straight line of the wall, `a` and `b` are small differences of
  // large numbers. Their rounding errors, times s or s^2, stay below those of the radius at the hit if s is
  // counted from the point of the slab nearest to the axis.
  Span wall_of(const Vec3<N>& f, const Vec3<N>& direction, const N& along_d, const Span& slab) const {
    using T = ScalarOf<N>;
    using std::abs;
    using std::sqrt;
    const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
    const Vec3<N> d_across = direction - axis * along_d;
    const N growth = slope * along_d, across2 = dot(d_across, d_across);
    const N to_axis = select(across2 > zero, N(-dot(f, d_across) / across2), zero);
    const N start = min_first(max_first(to_axis, slab.enter), slab.leave);
    const Vec3<N> p = f + direction * start;
    const N along = dot(p, axis);
    const Vec3<N> across = p - axis * along;
    const N from_axis = length(across), rho = radius + slope * along;

    const N a = across2 - growth * growth, b = rho * growth - dot(across, d_across);
    const N c = (from_axis - rho) * (from_axis + rho);
    const auto same_sign = a * c > zero;
    // b^2 - a c cancels if a and c have the same sign. By Lagrange's identity, it also is a difference of
    // squares, n^2 - j^2. The form with the smaller terms has the smaller rounding error.
    const N n = length(across * growth - d_across * rho), j = length(cross(across, d_across));
    const N d_length = sqrt(across2), size = from_axis * d_length + abs(rho * growth);
    const auto lagrange =
        same_sign && j * size < abs(b) * size + abs(c) * across2 + abs(a) * (from_axis * from_axis);
    const N discriminant = select(lagrange, N((n - j) * (n + j)), N(b * b - a * c));
    const N root = sqrt(select(discriminant > zero, discriminant, zero));
    const N q = b + select(b < zero, -root, root);
    // Rounding must not make the smaller of two roots of the same sign, c / q, the larger one.
    const N t1 = q / a, smaller = c / q;
    const auto equal = q == zero || (same_sign && abs(smaller) > abs(t1));
    const N t0 = select(equal, t1, smaller);
    const N first = min_first(t0, t1), second = max_first(t0, t1);
    const auto steep = a < zero;        // the ray meets both halves of the double cone
    const auto rising = growth > zero;  // toward the half with rho > 0
    const auto parallel = a == zero && b == zero;
    const N enter = select(steep, select(rising, second, -infinity), first);
    const N leave = select(steep, select(rising, infinity, first), second);
    const auto meets = steep || discriminant >= zero;
    return {
        select(parallel, select(c <= zero, -infinity, infinity), select(meets, N(start + enter), infinity)),
        select(parallel, infinity, N(start + leave))};
  }

  N distance_to_wall(const N& along, const N& from_axis) const {
    return (from_axis - (radius + slope * along)) * cosine;
  }

  MaskOf<N> is_on_cap(const N& along, const N& to_wall) const {
    using std::abs;
    return abs(half_length - abs(along)) < abs(to_wall);
  }
};

}  // namespace orrery
