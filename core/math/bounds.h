#pragma once

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "core/math/lanes.h"
#include "core/math/vec3.h"

namespace orrery {

// Axis-aligned box. Empty by default. Sides may be infinite.
template <class T>
struct Bounds {
  Vec3<T> lo{Vec3<T>(std::numeric_limits<T>::infinity())};
  Vec3<T> hi{Vec3<T>(-std::numeric_limits<T>::infinity())};

  void include(const Vec3<T>& p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  void include(const Bounds& b) {  // no effect if b is empty
    lo = {std::min(lo.x, b.lo.x), std::min(lo.y, b.lo.y), std::min(lo.z, b.lo.z)};
    hi = {std::max(hi.x, b.hi.x), std::max(hi.y, b.hi.y), std::max(hi.z, b.hi.z)};
  }
  bool bounded() const {
    return std::isfinite(lo.x) && std::isfinite(lo.y) && std::isfinite(lo.z) && std::isfinite(hi.x) &&
           std::isfinite(hi.y) && std::isfinite(hi.z);
  }
  bool contains(const Vec3<T>& p) const {
    return p.x >= lo.x && p.x <= hi.x && p.y >= lo.y && p.y <= hi.y && p.z >= lo.z && p.z <= hi.z;
  }
  bool contains(const Bounds& b) const { return contains(b.lo) && contains(b.hi); }
  // Returns whether the boxes have a common point.
  bool overlaps(const Bounds& b) const {
    return lo.x <= b.hi.x && b.lo.x <= hi.x && lo.y <= b.hi.y && b.lo.y <= hi.y && lo.z <= b.hi.z &&
           b.lo.z <= hi.z;
  }
  T diagonal() const { return length(hi - lo); }
  // Returns the largest absolute coordinate.
  T magnitude() const { return std::max(max_component(abs(lo)), max_component(abs(hi))); }

  static Bounds of(std::initializer_list<Vec3<T>> points) {
    Bounds b;
    for (const Vec3<T>& p : points) b.include(p);
    return b;
  }
  static Bounds around(const Vec3<T>& center, const Vec3<T>& half) {
    return of({center - half, center + half});
  }
  static Bounds everything() {
    Bounds b;
    b.lo = Vec3<T>(-std::numeric_limits<T>::infinity());
    b.hi = Vec3<T>(std::numeric_limits<T>::infinity());
    return b;
  }
};

using Boundsd = Bounds<double>;

inline std::array<Vec3<double>, 8> corners_of(const Boundsd& b) {
  std::array<Vec3<double>, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = {i & 1 ? b.hi.x : b.lo.x, i & 2 ? b.hi.y : b.lo.y, i & 4 ? b.hi.z : b.lo.z};
  return corners;
}

// Converts the box to precision T and pads each side by 4 epsilon times the largest absolute coordinate of
// the box. The padded box contains every hit that is computed in T and projected back onto the shape.
template <class T>
[[gnu::always_inline]] inline Bounds<T> padded(const Boundsd& b) {
  const T pad = static_cast<T>(b.magnitude()) * std::numeric_limits<T>::epsilon() * 4;
  Bounds<T> grown;
  grown.lo = Vec3<T>(b.lo) - Vec3<T>(pad);
  grown.hi = Vec3<T>(b.hi) + Vec3<T>(pad);
  return grown;
}

// Bound on the rounding error of a primitive test, relative to the largest absolute coordinate of the ray
// origin. Box tests enlarge boxes by this amount.
template <class T>
inline constexpr T kRounding = 16 * std::numeric_limits<T>::epsilon();

// Ray prepared for box tests.
template <class N>
struct BoxRay {
  Vec3<N> above, below;  // origin plus and minus the rounding error of primitive tests, on each axis
  Vec3<N> inverse;       // 1 / direction; infinite where a component is 0

  BoxRay(const Vec3<N>& origin, const Vec3<N>& direction)
      : inverse(N(ScalarOf<N>(1)) / direction.x, N(ScalarOf<N>(1)) / direction.y,
                N(ScalarOf<N>(1)) / direction.z) {
    const Vec3<N> pad(N(max_component(abs(origin)) * N(kRounding<ScalarOf<N>>)));
    above = origin + pad;
    below = origin - pad;
  }
};

// Returns the lanes whose ray may enter the box at a distance in [0, t_max]. Conservative: a ray that touches
// the box is never missed. The sign bit of the direction selects near and far planes. A NaN (0 * infinity, a
// ray in the plane of a face) leaves the interval unchanged. Far distances are multiplied by 1 + 4 epsilon
// (Ize, "Robust BVH Ray Traversal", JCGT 2013). t_max is multiplied by the same factor, because the near
// distance of a box may be rounded up beyond a hit in the box.
template <class N>
[[gnu::always_inline]] inline MaskOf<N> enters(const BoxRay<N>& ray, const Vec3<N>& lo, const Vec3<N>& hi,
                                               const N& t_max) {
  using T = ScalarOf<N>;
  constexpr T kFarPad = 1 + 4 * std::numeric_limits<T>::epsilon();
  N near = N(T(0)), far = t_max * kFarPad;
  const auto fold = [&](const N& lo_i, const N& hi_i, const N& above, const N& below, const N& inv) {
    using std::signbit;
    const auto negative = signbit(inv);
    const N t0 = (lo_i - above) * inv, t1 = (hi_i - below) * inv;
    near = max_first(near, select(negative, t1, t0));
    far = min_first(far, N(select(negative, t0, t1) * kFarPad));
  };
  fold(lo.x, hi.x, ray.above.x, ray.below.x, ray.inverse.x);
  fold(lo.y, hi.y, ray.above.y, ray.below.y, ray.inverse.y);
  fold(lo.z, hi.z, ray.above.z, ray.below.z, ray.inverse.z);
  return near <= far;
}

}  // namespace orrery
