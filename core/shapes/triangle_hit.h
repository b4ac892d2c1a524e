#pragma once

#include "core/model/batch.h"

namespace orrery {

// Where a ray crosses a triangle: distance and barycentric weights of the vertices, which sum to 1.
template <class N>
struct TriangleHit {
  N t;  // +infinity: no crossing ahead of the origin
  N weight_a, weight_b, weight_c;
};

namespace detail {

// x of the component named by the masks.
template <class N>
[[gnu::always_inline]] inline N pick(const MaskOf<N>& x, const MaskOf<N>& y, const Vec3<N>& v) {
  return select(x, v.x, select(y, v.y, v.z));
}

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

// Watertight: a ray through a shared edge or vertex meets one of the triangles around it, in any precision.
// The ray is turned and sheared to run along its largest axis, and each edge is judged by the sign of a 2D
// edge function that its two triangles compute from the same numbers (Woop, Benthin, Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2013).
template <class N>
[[gnu::always_inline]] inline TriangleHit<N> intersect_triangle(const Ray<N>& ray, const Vec3<N>& a,
                                                                const Vec3<N>& b, const Vec3<N>& c) {
  using T = ScalarOf<N>;
  const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
  const Vec3<N> size = abs(ray.direction);
  const auto z_is_x = size.x >= size.y && size.x >= size.z;
  const auto z_is_y = !z_is_x && size.y >= size.z;
  const auto z_is_z = !z_is_x && !z_is_y;
  const N dz = detail::pick(z_is_x, z_is_y, ray.direction);
  const N shear_x =
      detail::pick(z_is_z, z_is_x, ray.direction) / dz;  // x follows z cyclically: zxy, xyz, yzx
  const N shear_y = detail::pick(z_is_y, z_is_z, ray.direction) / dz;
  struct Sheared {
    N x, y, z;
  };
  const auto shear = [&](const Vec3<N>& vertex) {
    const Vec3<N> v = vertex - ray.origin;
    const N z = detail::pick(z_is_x, z_is_y, v);
    return Sheared{detail::pick(z_is_z, z_is_x, v) - shear_x * z,
                   detail::pick(z_is_y, z_is_z, v) - shear_y * z, z};
  };
  const Sheared sa = shear(a), sb = shear(b), sc = shear(c);
  const N u = detail::difference_of_products(sc.x, sb.y, sc.y, sb.x);
  const N v = detail::difference_of_products(sa.x, sc.y, sa.y, sc.x);
  const N w = detail::difference_of_products(sb.x, sa.y, sb.y, sa.x);
  const auto inside = (u >= zero && v >= zero && w >= zero) || (u <= zero && v <= zero && w <= zero);
  const N determinant = u + v + w;
  if (!any(inside && determinant != zero)) return {infinity, zero, zero, zero};
  const N inverse = N(T(1)) / determinant;
  const N t = (u * sa.z + v * sb.z + w * sc.z) * inverse / dz;
  return {select(inside && determinant != zero && t > zero, t, infinity), u * inverse, v * inverse,
          w * inverse};
}

}  // namespace orrery
