#pragma once

#include <algorithm>

#include "core/math/angles.h"
#include "core/math/vec3.h"

namespace orrery {

// Affine map p -> x p.x + y p.y + z p.z + origin.
template <class N>
struct Affine {
  Vec3<N> x{N(1), N(0), N(0)}, y{N(0), N(1), N(0)}, z{N(0), N(0), N(1)}, origin;

  Vec3<N> vector(const Vec3<N>& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3<N> point(const Vec3<N>& p) const { return vector(p) + origin; }
  // Multiplies `v` by the transpose of the linear part. On the inverse map, this function transforms a normal
  // without normalising it.
  Vec3<N> transposed(const Vec3<N>& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }

  template <class M>
  Affine<M> as() const {
    return {Vec3<M>(x), Vec3<M>(y), Vec3<M>(z), Vec3<M>(origin)};
  }
};

using Affined = Affine<double>;

// Returns the map that applies `inner`, then `outer`.
inline Affined compose(const Affined& outer, const Affined& inner) {
  return {outer.vector(inner.x), outer.vector(inner.y), outer.vector(inner.z), outer.point(inner.origin)};
}

// Returns the linear part divided by its largest absolute entry, so that products of three entries cannot
// overflow. Sets the origin to 0. Returns `a` if the linear part is 0.
inline Affined scaled(const Affined& a) {
  const double largest =
      std::max({max_component(abs(a.x)), max_component(abs(a.y)), max_component(abs(a.z))});
  return largest > 0 ? Affined{a.x / largest, a.y / largest, a.z / largest, {}} : a;
}

// Returns the determinant of scaled(a): negative if the map mirrors, 0 if the map has no inverse.
inline double scaled_determinant(const Affined& a) {
  const Affined s = scaled(a);
  return dot(s.x, cross(s.y, s.z));
}

// Transforms a surface normal without normalising it. The cofactor matrix times the sign of the determinant
// is a positive multiple of the inverse transpose.
inline Vec3d transformed_normal(const Affined& a, const Vec3d& n) {
  const Affined s = scaled(a);
  const Vec3d turned = cross(s.y, s.z) * n.x + cross(s.z, s.x) * n.y + cross(s.x, s.y) * n.z;
  return scaled_determinant(a) < 0 ? -turned : turned;
}

// Returns the inverse map. REQUIRES: scaled_determinant(a) != 0.
inline Affined inverse(const Affined& a) {
  const double largest =
      std::max({max_component(abs(a.x)), max_component(abs(a.y)), max_component(abs(a.z))});
  const Affined s = scaled(a);
  const double over = 1 / (dot(s.x, cross(s.y, s.z)) * largest);
  const Vec3d row_x = cross(s.y, s.z) * over, row_y = cross(s.z, s.x) * over, row_z = cross(s.x, s.y) * over;
  Affined inverse{{row_x.x, row_y.x, row_z.x}, {row_x.y, row_y.y, row_z.y}, {row_x.z, row_y.z, row_z.z}, {}};
  inverse.origin = -inverse.vector(a.origin);
  return inverse;
}

// Returns the largest factor by which the linear part can increase the largest absolute coordinate of a
// vector.
inline double stretch(const Affined& a) { return max_component(abs(a.x) + abs(a.y) + abs(a.z)); }

// Returns the rotation by `degrees` about the unit vector `axis`, anticlockwise as seen from its tip
// (Rodrigues).
inline Affined rotation(const Vec3d& axis, double degrees) {
  const SineCosine turn = sine_cosine_degrees(degrees);
  const double c = turn.cosine, s = turn.sine;
  const auto turned = [&](const Vec3d& v) {
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
  };
  return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}), {}};
}

}  // namespace orrery
