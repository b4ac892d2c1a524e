#pragma once

#include "core/math/bounds.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"

namespace orrery {

// Axis-aligned box.
template <class N>
struct Box {
  Vec3<N> lo, hi;
  N magnitude;  // largest absolute coordinate

  static constexpr ShapeTraits kTraits = {.convex = true, .closed = true};

  static void read(Params& p, std::vector<Box<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return Boundsd::of({lo, hi}); }

  Patch patch() const {
    const Vec3d half = (hi - lo) * 0.5;
    return {Patch::Kind::box, lo + half, {half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}};
  }

  // Returns the distance to the point where the ray enters the box, or leaves it if the origin is inside.
  // Returns infinity for a miss. A ray in the plane of a face gives 0 / 0 for the slab of the face. min_first
  // and max_first ignore this NaN.
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    using std::signbit;
    const N infinity(std::numeric_limits<T>::infinity());
    N enter = -infinity, leave = infinity;
    const auto slab = [&](const N& lo_i, const N& hi_i, const N& o, const N& d) {
      const auto negative = signbit(d);
      enter = max_first(enter, N((select(negative, hi_i, lo_i) - o) / d));
      leave = min_first(leave, N((select(negative, lo_i, hi_i) - o) / d));
    };
    slab(lo.x, hi.x, ray.origin.x, ray.direction.x);
    slab(lo.y, hi.y, ray.origin.y, ray.direction.y);
    slab(lo.z, hi.z, ray.origin.z, ray.direction.z);
    const N t = select(enter > N(T(0)), enter, leave);
    const Vec3<N> sum = ray.origin + ray.direction;
    const N whole = sum.x + sum.y + sum.z;  // NaN if the ray contains NaN: no hit
    return select(enter <= leave && t > N(T(0)) && whole == whole, t, infinity);
  }

  // Returns the surface of the face that is nearest to the ray's point at `t`. The distance to a face is
  // measured relative to the size of the box along the axis of the face.
  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const Vec3<N> near = ray.at(t);
    const auto offset = [](const N& lo_i, const N& hi_i, const N& x) {
      return N((x - lo_i) - (hi_i - x)) / N(hi_i - lo_i);  // -1 at lo, +1 at hi
    };
    const Vec3<N> u(offset(lo.x, hi.x, near.x), offset(lo.y, hi.y, near.y), offset(lo.z, hi.z, near.z));
    const Vec3<N> size = abs(u);
    const auto on_x = size.x >= size.y && size.x >= size.z;
    const auto on_y = !on_x && size.y >= size.z;
    const auto on_z = !on_x && !on_y;
    const Vec3<N> normal(select(on_x, select(u.x > zero, one, -one), zero),
                         select(on_y, select(u.y > zero, one, -one), zero),
                         select(on_z, select(u.z > zero, one, -one), zero));
    const auto settle = [&](const auto& on, const N& x, const N& lo_i, const N& hi_i, const N& side) {
      return select(on, select(side > zero, hi_i, lo_i), min_first(max_first(x, lo_i), hi_i));
    };
    const Vec3<N> position(settle(on_x, near.x, lo.x, hi.x, u.x), settle(on_y, near.y, lo.y, hi.y, u.y),
                           settle(on_z, near.z, lo.z, hi.z, u.z));
    return {position, normal, normal, magnitude};
  }

  // Returns u and v in [0, 1] on each face. They increase with x and y on faces perpendicular to z, with x
  // and z on faces perpendicular to y, and with z and y on faces perpendicular to x.
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const Vec3<N> from_lo = position - lo, size = hi - lo;
    const Vec3<N> share(from_lo.x / size.x, from_lo.y / size.y, from_lo.z / size.z);
    const auto on = [&](const N& at) { return at == zero || at == one; };
    const auto on_x = on(share.x), on_y = !on_x && on(share.y);
    const N u = select(on_x, share.z, share.x), v = select(on_y, share.z, share.y);
    return {u, v, u, v, {select(on_x, zero, one), zero, select(on_x, one, zero)}};
  }
};

}  // namespace orrery
