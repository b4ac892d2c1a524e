#pragma once

#include "core/math/bounds.h"
#include "core/math/products.h"
#include "core/model/shape.h"

namespace orrery {

// Intersection of a ray and a triangle: distance and barycentric weights of the vertices, which sum to 1.
template <class N>
struct TriangleHit {
  N t;  // +infinity: no hit ahead of the origin
  N weight_a, weight_b, weight_c;
};

namespace detail {

// Returns coordinate `axis` of point - origin. Scalar points or origins apply to all lanes.
template <class N, class V, class O>
[[gnu::always_inline]] inline N moved(const Vec3<V>& point, const Vec3<O>& origin, int axis) {
  return N(point[axis]) - N(origin[axis]);
}

}  // namespace detail

// Point in ray space. The axes are permuted so that z is the axis of the largest component of the ray's
// direction, and sheared so that the ray runs along z.
template <class N>
struct Sheared {
  N x, y, z;
};

// Transform to ray space, with separate axes for the ray of each lane.
template <class N>
class OwnAxes {
 public:
  [[gnu::always_inline]] explicit OwnAxes(const Ray<N>& ray)
      : origin_(ray.origin), axes_(ray.direction), shear_(Shear<N>::of(axes_, ray.direction)) {}
  [[gnu::always_inline]] Sheared<N> operator()(const Vec3<N>& vertex) const {
    const Vec3<N> v = vertex - origin_;
    const N z = axes_.z(v);
    return {axes_.x(v) - shear_.x * z, axes_.y(v) - shear_.y * z, z};
  }
  [[gnu::always_inline]] N along() const { return shear_.z; }

 private:
  Vec3<N> origin_;
  RayAxes<N> axes_;
  Shear<N> shear_;
};

// Transform to ray space with the axes of a SingleRay or a Packet, which are the same for all lanes.
template <class N, class Rays>
class SharedAxes {
 public:
  [[gnu::always_inline]] explicit SharedAxes(const Rays& rays) : rays_(rays) {}
  template <class V>
  [[gnu::always_inline]] Sheared<N> operator()(const Vec3<V>& vertex) const {
    const auto [x, y, z] = rays_.axis;
    const auto moved = [&](int axis) { return detail::moved<N>(vertex, rays_.ray.origin, axis); };
    const N vx = moved(x), vy = moved(y), vz = moved(z);
    return {vx - N(rays_.shear.x) * vz, vy - N(rays_.shear.y) * vz, vz};
  }
  [[gnu::always_inline]] N along() const { return N(rays_.shear.z); }

 private:
  const Rays& rays_;
};

// Intersects a ray with a triangle, watertight: a ray through a shared edge or vertex hits at least one of
// the triangles around it, in any precision. Each edge is classified by the sign of a 2D edge function that
// both adjacent triangles compute from the same numbers (Woop, Benthin, Wald, "Watertight Ray/Triangle
// Intersection", JCGT 2013). The products of the edge functions are not rounded before subtraction. The
// vertex weights are therefore as exact as the sheared vertices, even for thin triangles and grazing rays.
// Points interpolated by the weights are within a few roundings of the ray.
template <class N, class Axes, class V>
[[gnu::always_inline]] inline TriangleHit<N> intersect_triangle(const Axes& axes, const Vec3<V>& a,
                                                                const Vec3<V>& b, const Vec3<V>& c) {
  using std::abs;
  using T = ScalarOf<N>;
  const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
  const Sheared<N> sa = axes(a), sb = axes(b), sc = axes(c);
  const N u = difference_of_products(sc.x, sb.y, sc.y, sb.x);
  const N v = difference_of_products(sa.x, sc.y, sa.y, sc.x);
  const N w = difference_of_products(sb.x, sa.y, sb.y, sa.x);
  const auto inside = min_first(min_first(u, v), w) >= zero || max_first(max_first(u, v), w) <= zero;
  const N determinant = u + v + w, inverse = N(T(1)) / determinant;
  const N z = (u * sa.z + v * sb.z + w * sc.z) * inverse, t = z / axes.along();
  // A distance below its rounding error means that the ray starts on the triangle. This is not a hit.
  const N farthest = max_first(max_first(abs(sa.z), abs(sb.z)), abs(sc.z));
  const auto met = inside && determinant != zero && t > zero &&
                   abs(z) > farthest * (4 * std::numeric_limits<T>::epsilon());
  return {select(met, t, infinity), u * inverse, v * inverse, w * inverse};
}

// Values at the corners of a triangle, such as positions or normals. The functions except mix() require
// positions.
template <class N>
struct Corners {
  Vec3<N> a, b, c;

  Boundsd bounds() const { return Boundsd::of({a, b, c}); }
  std::vector<HullTriangle> hull() const { return {{Vec3d(a), Vec3d(b), Vec3d(c)}}; }

  N distance(const Ray<N>& ray) const { return distance_by(OwnAxes<N>(ray)); }
  N distance(const SingleRay<ScalarOf<N>>& single) const {
    return distance_by(SharedAxes<N, SingleRay<ScalarOf<N>>>(single));
  }
  // Returns the distance along each ray of the packet to one triangle.
  template <class T>
  Lanes<T> distance(const Packet<T>& packet) const requires std::is_same_v<T, N> {
    return intersect_triangle<Lanes<T>>(SharedAxes<Lanes<T>, Packet<T>>(packet), a, b, c).t;
  }
  // Returns false for triangles that no active ray of the packet can hit: in the ray space of each of these
  // rays, all corners are on the same side of the ray along x or along y. Rounding is monotonic, so the
  // rounded coordinates of a ray are between the rounded coordinates for both ends of the range of shears.
  MaskOf<N> may_meet(const Packet<ScalarOf<N>>& packet) const {
    if (!packet.one_origin) return MaskOf<N>(true);
    return !misses_side(packet, 0) && !misses_side(packet, 1);
  }
  // Returns the barycentric weights of the intersection.
  Vec3<N> weights(const Ray<N>& ray) const {
    const TriangleHit<N> hit = intersect_triangle<N>(OwnAxes<N>(ray), a, b, c);
    return {hit.weight_a, hit.weight_b, hit.weight_c};
  }
  Vec3<N> mix(const Vec3<N>& weights) const { return a * weights.x + b * weights.y + c * weights.z; }

 private:
  template <class Axes>
  [[gnu::always_inline]] N distance_by(const Axes& axes) const {
    return intersect_triangle<N>(axes, a, b, c).t;
  }
  [[gnu::always_inline]] MaskOf<N> misses_side(const Packet<ScalarOf<N>>& packet, std::size_t side) const {
    using T = ScalarOf<N>;
    const auto moved = [&](const Vec3<N>& v, std::size_t i) {
      return detail::moved<N>(v, packet.origin, packet.axis[i]);
    };
    N least(std::numeric_limits<T>::infinity()), most(-std::numeric_limits<T>::infinity());
    for (const Vec3<N>* corner : {&a, &b, &c}) {
      const N x = moved(*corner, side), z = moved(*corner, 2);
      const N lo = x - N(packet.shear_lo[side]) * z, hi = x - N(packet.shear_hi[side]) * z;
      least = min_first(least, min_first(lo, hi));
      most = max_first(most, max_first(lo, hi));
    }
    return least > N(T(0)) || most < N(T(0));
  }
};

inline Patch patch_of(const Corners<double>& corners) {
  return {Patch::Kind::triangle, corners.a, corners.b - corners.a, corners.c - corners.a};
}

}  // namespace orrery
