#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "core/math/lanes.h"

namespace orrery {

// Vector of three components of one number type: a scalar (float, double, long double) or lanes. Used for
// points, directions and linear colours.
template <class N>
struct Vec3 {
  N x{}, y{}, z{};

  Vec3() = default;
  constexpr Vec3(N x_, N y_, N z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit Vec3(N all) : x(all), y(all), z(all) {}
  template <class M>
  requires(!std::is_same_v<M, N>) constexpr explicit Vec3(const Vec3<M>& v)
      : x(static_cast<N>(v.x)), y(static_cast<N>(v.y)), z(static_cast<N>(v.z)) {}

  // Returns the component along `axis`: 0 is x, 1 is y, 2 is z. REQUIRES: axis < 3.
  [[gnu::always_inline]] constexpr N& operator[](std::size_t axis) { return at(*this, axis); }
  [[gnu::always_inline]] constexpr const N& operator[](std::size_t axis) const { return at(*this, axis); }

  bool operator==(const Vec3&) const = default;

 private:
  // Compiles to one indexed load without a branch, because traversals select the axis per ray.
  template <class V>
  [[gnu::always_inline]] static constexpr auto& at(V& v, std::size_t axis) {
    static_assert(sizeof(Vec3) == 3 * sizeof(N), "the components are contiguous in memory");
    assert(axis < 3);
    if (std::is_constant_evaluated()) return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
    return (&v.x)[axis];
  }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;

template <class N>
[[gnu::always_inline]] inline Vec3<N> operator+(const Vec3<N>& a, const Vec3<N>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> operator-(const Vec3<N>& a, const Vec3<N>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> operator-(const Vec3<N>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> operator*(const Vec3<N>& a, const Vec3<N>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> operator*(const Vec3<N>& a, const std::type_identity_t<N>& s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> operator*(const std::type_identity_t<N>& s, const Vec3<N>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> operator/(const Vec3<N>& a, const std::type_identity_t<N>& s) {
  return {a.x / s, a.y / s, a.z / s};
}

template <class N>
[[gnu::always_inline]] inline N dot(const Vec3<N>& a, const Vec3<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> cross(const Vec3<N>& a, const Vec3<N>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class N>
[[gnu::always_inline]] inline N length(const Vec3<N>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

// Returns the unit vector along `a`. REQUIRES: dot(a, a) neither overflows nor underflows to 0. Use
// `safe_normalize` for input of any magnitude.
template <class N>
[[gnu::always_inline]] inline Vec3<N> normalize(const Vec3<N>& a) {
  return a * (N(1) / length(a));
}

// Returns the component-wise maximum.
template <class N>
[[gnu::always_inline]] inline Vec3<N> largest(const Vec3<N>& a, const Vec3<N>& b) {
  return {max_first(a.x, b.x), max_first(a.y, b.y), max_first(a.z, b.z)};
}
template <class N>
[[gnu::always_inline]] inline N max_component(const Vec3<N>& a) {
  using std::max;
  return max(max(a.x, a.y), a.z);
}
template <class N>
[[gnu::always_inline]] inline Vec3<N> abs(const Vec3<N>& a) {
  using std::abs;
  return {abs(a.x), abs(a.y), abs(a.z)};
}

// Returns the components of `a` where the mask is set, else the components of `b`.
template <class N>
[[gnu::always_inline]] inline Vec3<N> select(const std::type_identity_t<MaskOf<N>>& mask, const Vec3<N>& a,
                                             const Vec3<N>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

// Returns the unit vector along a scalar vector of any finite magnitude, or 0 for 0. Scales the largest
// component to 1 first, so that the squares of 1e-200 and 1e200 neither underflow nor overflow.
template <class N>
requires std::is_floating_point_v<N>
[[gnu::always_inline]] inline Vec3<N> safe_normalize(const Vec3<N>& a) {
  const N largest = max_component(abs(a));
  if (!(largest > 0)) return Vec3<N>{};
  const Vec3<N> scaled = a / largest;
  return scaled / length(scaled);
}

}  // namespace orrery
