#pragma once

#include "core/math/bounds.h"
#include "core/model/lone_ray.h"

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

}  // namespace detail

// A ray turned and sheared to run along its largest axis z, as it sees points: x and y follow z cyclically.
template <class N>
struct Sheared {
  N x, y, z;
};

// Each lane has its own ray and so its own axes.
template <class N>
class RayShear {
 public:
  [[gnu::always_inline]] explicit RayShear(const Ray<N>& ray) : origin_(ray.origin), axes_(ray.direction) {
    along_ = axes_.z(ray.direction);
    x_ = axes_.x(ray.direction) / along_;
    y_ = axes_.y(ray.direction) / along_;
  }
  [[gnu::always_inline]] Sheared<N> operator()(const Vec3<N>& vertex) const {
    const Vec3<N> v = vertex - origin_;
    const N z = axes_.z(v);
    return {axes_.x(v) - x_ * z, axes_.y(v) - y_ * z, z};
  }
  [[gnu::always_inline]] N along() const { return along_; }

 private:
  Vec3<N> origin_;
  RayAxes<N> axes_;
  N along_, x_, y_;
};

// One ray for all lanes.
template <class N>
class LoneShear {
 public:
  [[gnu::always_inline]] explicit LoneShear(const LoneRay<ScalarOf<N>>& ray) : ray_(ray) {}
  [[gnu::always_inline]] Sheared<N> operator()(const Vec3<N>& vertex) const {
    const auto [x, y, z] = ray_.axis;
    const N vx = moved(vertex, x), vy = moved(vertex, y), vz = moved(vertex, z);
    return {vx - N(ray_.shear_x) * vz, vy - N(ray_.shear_y) * vz, vz};
  }
  [[gnu::always_inline]] N along() const { return N(ray_.along); }

 private:
  [[gnu::always_inline]] N moved(const Vec3<N>& v, int i) const { return (&v.x)[i] - N((&ray_.origin.x)[i]); }
  const LoneRay<ScalarOf<N>>& ray_;
};

// Watertight: a ray through a shared edge or vertex meets one of the triangles around it, in any precision.
// Each edge is judged by the sign of a 2D edge function that its two triangles compute from the same numbers
// (Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2013).
template <class N, class Shear>
[[gnu::always_inline]] inline TriangleHit<N> intersect_triangle(const Shear& shear, const Vec3<N>& a,
                                                                const Vec3<N>& b, const Vec3<N>& c) {
  using T = ScalarOf<N>;
  const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
  const Sheared<N> sa = shear(a), sb = shear(b), sc = shear(c);
  const N u = detail::difference_of_products(sc.x, sb.y, sc.y, sb.x);
  const N v = detail::difference_of_products(sa.x, sc.y, sa.y, sc.x);
  const N w = detail::difference_of_products(sb.x, sa.y, sb.y, sa.x);
  const auto inside = (u >= zero && v >= zero && w >= zero) || (u <= zero && v <= zero && w <= zero);
  const N determinant = u + v + w;
  if (!any(inside && determinant != zero)) return {infinity, zero, zero, zero};
  const N inverse = N(T(1)) / determinant;
  const N t = (u * sa.z + v * sb.z + w * sc.z) * inverse / shear.along();
  return {select(inside && determinant != zero && t > zero, t, infinity), u * inverse, v * inverse,
          w * inverse};
}

// What stands at the corners of a triangle; if it is where they are, all that a test of a ray needs.
template <class N>
struct Corners {
  Vec3<N> a, b, c;

  Boundsd bounds() const { return Boundsd::of({a, b, c}); }

  N distance(const Ray<N>& ray) const { return intersect_triangle(RayShear<N>(ray), a, b, c).t; }
  N distance(const LoneRay<ScalarOf<N>>& ray) const {
    return intersect_triangle(LoneShear<N>(ray), a, b, c).t;
  }
  // Barycentric weights where the ray crosses.
  Vec3<N> weights(const Ray<N>& ray) const {
    const TriangleHit<N> hit = intersect_triangle(RayShear<N>(ray), a, b, c);
    return {hit.weight_a, hit.weight_b, hit.weight_c};
  }
  Vec3<N> mix(const Vec3<N>& weights) const { return a * weights.x + b * weights.y + c * weights.z; }
};

}  // namespace orrery
