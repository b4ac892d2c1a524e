#pragma once

#include "core/math/bounds.h"
#include "core/math/face_normal.h"
#include "core/model/shape.h"

namespace orrery {

// Where a ray crosses a triangle: distance and barycentric weights of the vertices, which sum to 1.
template <class N>
struct TriangleHit {
  N t;  // +infinity: no crossing ahead of the origin
  N weight_a, weight_b, weight_c;
};

namespace detail {

// a * b - c * d with the right sign: rounding cannot turn the sign of a difference of rounded products, only
// make it 0, and then the rounding errors of the products decide.
template <class N>
[[gnu::always_inline]] inline N difference_of_products(const N& a, const N& b, const N& c, const N& d) {
  using std::fma;
  const N ab = a * b, cd = c * d;
  const N difference = ab - cd;
  const auto undecided = difference == N(ScalarOf<N>(0));
  if (!any(undecided)) return difference;
  return select(undecided, N(fma(a, b, -ab) - fma(c, d, -cd)), difference);
}

// One coordinate of a point as seen from `origin`.
template <class N, class O>
[[gnu::always_inline]] inline N moved(const Vec3<N>& point, const Vec3<O>& origin, int axis) {
  return point[axis] - N(origin[axis]);
}

}  // namespace detail

// A point as a ray sees it that is turned and sheared to run along its largest axis z.
template <class N>
struct Sheared {
  N x, y, z;
};

namespace detail {

// Whether a ray that crosses the triangle of three points, seen from its origin, crosses their plane ahead
// and does not start on it. The plane's normal is taken from the two shorter sides: its relative error stays
// a few ulp however thin the triangle is.
template <class N>
inline MaskOf<N> plane_ahead(const Vec3<N>& va, const Vec3<N>& vb, const Vec3<N>& vc,
                             const Vec3<N>& direction) {
  const Vec3<N> ab = vb - va, bc = vc - vb, ca = va - vc;
  const N la = dot(bc, bc), lb = dot(ca, ca), lc = dot(ab, ab);
  const auto first = la >= lb && la >= lc;  // bc is longest
  const auto second = !first && lb >= lc;   // ca is
  const auto choose = [&](const N& p, const N& q, const N& r) {
    return select(first, p, select(second, q, r));
  };
  const Vec3<N> e(choose(ca.x, ab.x, bc.x), choose(ca.y, ab.y, bc.y), choose(ca.z, ab.z, bc.z));
  const Vec3<N> f(choose(ab.x, bc.x, ca.x), choose(ab.y, bc.y, ca.y), choose(ab.z, bc.z, ca.z));
  const Vec3<N> at(choose(va.x, vb.x, vc.x), choose(va.y, vb.y, vc.y), choose(va.z, vb.z, vc.z));
  const Vec3<N> normal = cross(e, f);
  const N zero(ScalarOf<N>(0)), distance = dot(at, normal);
  return select(dot(direction, normal) > zero, distance, N(-distance)) > zero;
}

}  // namespace detail

// Each lane has its own ray and so its own axes.
template <class N>
class OwnAxes {
 public:
  [[gnu::always_inline]] explicit OwnAxes(const Ray<N>& ray)
      : origin_(ray.origin),
        direction_(ray.direction),
        axes_(ray.direction),
        shear_(Shear<N>::of(axes_, ray.direction)) {}
  [[gnu::always_inline]] Sheared<N> operator()(const Vec3<N>& vertex) const {
    const Vec3<N> v = vertex - origin_;
    const N z = axes_.z(v);
    return {axes_.x(v) - shear_.x * z, axes_.y(v) - shear_.y * z, z};
  }
  [[gnu::always_inline]] N along() const { return shear_.z; }
  const Vec3<N>& origin() const { return origin_; }
  const Vec3<N>& direction() const { return direction_; }

 private:
  Vec3<N> origin_, direction_;
  RayAxes<N> axes_;
  Shear<N> shear_;
};

// All lanes have the same axes: those of a SingleRay or a Packet.
template <class N, class Rays>
class SharedAxes {
 public:
  [[gnu::always_inline]] explicit SharedAxes(const Rays& rays) : rays_(rays) {}
  [[gnu::always_inline]] Sheared<N> operator()(const Vec3<N>& vertex) const {
    const auto [x, y, z] = rays_.axis;
    const auto moved = [&](int axis) { return detail::moved(vertex, rays_.ray.origin, axis); };
    const N vx = moved(x), vy = moved(y), vz = moved(z);
    return {vx - N(rays_.shear.x) * vz, vy - N(rays_.shear.y) * vz, vz};
  }
  [[gnu::always_inline]] N along() const { return N(rays_.shear.z); }
  Vec3<N> origin() const { return lanes_of(rays_.ray.origin); }
  Vec3<N> direction() const { return lanes_of(rays_.ray.direction); }

 private:
  static Vec3<N> lanes_of(const auto& v) { return {N(v.x), N(v.y), N(v.z)}; }
  const Rays& rays_;
};

// Watertight: a ray through a shared edge or vertex meets one of the triangles around it, in any precision.
// Each edge is judged by the sign of a 2D edge function that its two triangles compute from the same numbers
// (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013).
template <class N, class Axes>
[[gnu::always_inline]] inline TriangleHit<N> intersect_triangle(const Axes& axes, const Vec3<N>& a,
                                                                const Vec3<N>& b, const Vec3<N>& c) {
  using std::abs;
  using T = ScalarOf<N>;
  const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
  const Sheared<N> sa = axes(a), sb = axes(b), sc = axes(c);
  N u = sc.x * sb.y - sc.y * sb.x, v = sa.x * sc.y - sa.y * sc.x, w = sb.x * sa.y - sb.y * sa.x;
  if (any(u == zero || v == zero || w == zero)) [[unlikely]] {
    u = detail::difference_of_products(sc.x, sb.y, sc.y, sb.x);
    v = detail::difference_of_products(sa.x, sc.y, sa.y, sc.x);
    w = detail::difference_of_products(sb.x, sa.y, sb.y, sa.x);
  }
  const auto inside = min_first(min_first(u, v), w) >= zero || max_first(max_first(u, v), w) <= zero;
  const N determinant = u + v + w;
  if (!any(inside && determinant != zero)) return {infinity, zero, zero, zero};
  const N inverse = N(T(1)) / determinant;
  const N t = (u * sa.z + v * sb.z + w * sc.z) * inverse / axes.along();
  auto met = inside && determinant != zero && t > zero;
  // Of a long thin triangle, whose determinant is small, t may be far off: next to the triangle, where its
  // sign is in doubt, the plane decides.
  const N farthest = max_first(max_first(abs(sa.z), abs(sb.z)), abs(sc.z));
  const auto near = met && abs(t * axes.along()) < farthest * N(T(1.0 / 1024));
  if (any(near)) [[unlikely]]
    met = met && (!near || detail::plane_ahead(a - axes.origin(), b - axes.origin(), c - axes.origin(),
                                               axes.direction()));
  return {select(met, t, infinity), u * inverse, v * inverse, w * inverse};
}

// What stands at the corners of a triangle; if it is where they are, all that a test of a ray needs.
template <class N>
struct Corners {
  Vec3<N> a, b, c;

  Boundsd bounds() const { return Boundsd::of({a, b, c}); }
  std::vector<HullTriangle> hull() const { return {{Vec3d(a), Vec3d(b), Vec3d(c)}}; }

  N distance(const Ray<N>& ray) const { return distance_by(OwnAxes<N>(ray)); }
  N distance(const SingleRay<ScalarOf<N>>& single) const {
    return distance_by(SharedAxes<N, SingleRay<ScalarOf<N>>>(single));
  }
  N distance(const Packet<ScalarOf<N>>& packet) const requires std::is_same_v<N, Lanes<ScalarOf<N>>> {
    return distance_by(SharedAxes<N, Packet<ScalarOf<N>>>(packet));
  }
  // Whether an active ray of the packet may cross: not if the corners, as all these rays see them, lie on one
  // side of an axis. Their rounded shears are between those of the limits, because rounding keeps order.
  MaskOf<N> may_meet(const Packet<ScalarOf<N>>& packet) const {
    if (!packet.one_origin) return MaskOf<N>(true);
    return !beside(packet, 0) && !beside(packet, 1);
  }
  // Barycentric weights where the ray crosses.
  Vec3<N> weights(const Ray<N>& ray) const {
    const TriangleHit<N> hit = intersect_triangle(OwnAxes<N>(ray), a, b, c);
    return {hit.weight_a, hit.weight_b, hit.weight_c};
  }
  Vec3<N> mix(const Vec3<N>& weights) const { return a * weights.x + b * weights.y + c * weights.z; }

  // Where the ray crosses with these weights; `normal` is that of the triangle. Rounding moves the weights of
  // a triangle of length l and width w by eps l / w, and what they mix by l times as much along it: of a long
  // thin one, the point is taken where the ray crosses the plane, if that is the nearer to the truth.
  Vec3<N> point(const Ray<N>& ray, const Vec3<N>& normal, const Vec3<N>& weights) const {
    using std::abs;
    using std::sqrt;
    const Vec3<N> mixed = mix(weights), ab = b - a, bc = c - b, ca = a - c, product = cross(ab, ca);
    const N longest2 = max_first(max_first(dot(ab, ab), dot(bc, bc)), dot(ca, ca)), area = length(product);
    const auto thin = area * ScalarOf<N>(kThinAspect) < longest2;
    if (!any(thin)) [[likely]]
      return mixed;
    const N slope = dot(ray.direction, normal), t = dot(mixed - ray.origin, normal) / slope;
    const N far = abs(t) * dot(ray.direction, ray.direction);
    const auto nearer = thin && far * area < longest2 * sqrt(longest2) * abs(slope);
    const Vec3<N> at = ray.at(t), crossing = at - normal * dot(at - mixed, normal);
    return {select(nearer, crossing.x, mixed.x), select(nearer, crossing.y, mixed.y),
            select(nearer, crossing.z, mixed.z)};
  }

 private:
  template <class Axes>
  [[gnu::always_inline]] N distance_by(const Axes& axes) const {
    return intersect_triangle(axes, a, b, c).t;
  }
  [[gnu::always_inline]] MaskOf<N> beside(const Packet<ScalarOf<N>>& packet, std::size_t side) const {
    using T = ScalarOf<N>;
    const auto moved = [&](const Vec3<N>& v, std::size_t i) {
      return detail::moved(v, packet.origin, packet.axis[i]);
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

}  // namespace orrery
