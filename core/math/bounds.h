#pragma once

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "core/math/lanes.h"
#include "core/math/vec3.h"

namespace orrery {

// An axis-aligned box. Empty when made by default; infinite sides are allowed.
template <class T>
struct Bounds {
  Vec3<T> lo{Vec3<T>(std::numeric_limits<T>::infinity())};
  Vec3<T> hi{Vec3<T>(-std::numeric_limits<T>::infinity())};

  void include(const Vec3<T>& p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  void include(const Bounds& b) {  // nothing changes if that is empty
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
  T diagonal() const { return length(hi - lo); }
  // Largest absolute coordinate.
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

// The box in another precision, grown outward by 4 ulp of its largest coordinate on every side, so that a
// hit computed in that precision and put back on its shape still lies inside.
template <class T>
[[gnu::always_inline]] inline Bounds<T> padded(const Boundsd& b) {
  const T pad = static_cast<T>(b.magnitude()) * std::numeric_limits<T>::epsilon() * 4;
  Bounds<T> grown;
  grown.lo = Vec3<T>(b.lo) - Vec3<T>(pad);
  grown.hi = Vec3<T>(b.hi) + Vec3<T>(pad);
  return grown;
}

// How far testing a primitive may move it, per metre of the ray's origin from 0: boxes are met as much
// larger.
template <class T>
inline constexpr T kRounding = 16 * std::numeric_limits<T>::epsilon();

// A ray for testing boxes.
template <class N>
struct BoxRay {
  Vec3<N> above, below;  // the origin, as far up and down each axis as rounding may move what is in a box
  Vec3<N> inverse;       // 1 / direction, infinite where that is 0

  BoxRay(const Vec3<N>& origin, const Vec3<N>& direction)
      : inverse(N(ScalarOf<N>(1)) / direction.x, N(ScalarOf<N>(1)) / direction.y,
                N(ScalarOf<N>(1)) / direction.z) {
    const Vec3<N> pad(N(max_component(abs(origin)) * N(kRounding<ScalarOf<N>>)));
    above = origin + pad;
    below = origin - pad;
  }
};

// Lanes that may enter the box at a distance in [0, t_max]; conservative: a ray that touches it is never
// lost. Near and far planes are chosen by the sign bit of the direction; a NaN (0 * infinity, a ray in the
// plane of a face) loses against the interval so far; the far side grows by 4 ulp (Ize, "Robust BVH Ray
// Traversal", JCGT 2013), and so does t_max: what lies in the box may be as near as the hit so far, or nearer
// by rounding.
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
