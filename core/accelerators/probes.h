#pragma once

#include <array>
#include <cmath>

#include "core/math/compress.h"
#include "core/model/lone_ray.h"

// Probes: what a walk holds against the boxes of a wide node, a block of them at once.
//
// A probe is conservative: a box in which a primitive's computed hit may lie is never refused. Boxes are
// grown by padded() for the rounding of what is in them; each probe moves its planes apart by kRounding ulp
// of the origin's largest coordinate, and stretches the far end by a few ulp, for the rounding of distances
// in the slab test and in the hits (Ize, "Robust BVH Ray Traversal", JCGT 2013, extended to the hits' own
// errors).
namespace orrery {

#ifndef FAN
#define FAN 16
#endif
template <class T>
inline constexpr int kFan = std::min<int>(FAN, static_cast<int>(Lanes<T>::size()));
template <class T>
using FanLanes = stdx::simd<T, stdx::simd_abi::deduce_t<T, kFan<T>>>;

template <class T>
inline constexpr T kRounding = 16 * std::numeric_limits<T>::epsilon();
template <class T>
inline constexpr T kFarther = 1 + 8 * std::numeric_limits<T>::epsilon();

// Boxes of the children of one node: planes[2 * axis] holds their low sides, planes[2 * axis + 1] their high
// sides.
template <class T>
using BoxPlanes = std::array<FanLanes<T>, 6>;

// One ray.
template <class T>
class RayProbe {
 public:
  using B = FanLanes<T>;

  explicit RayProbe(const LoneRay<T>& ray) {
    const T pad = max_component(abs(ray.origin)) * kRounding<T>;
    set(0, ray.origin.x, ray.inverse.x, pad);
    set(1, ray.origin.y, ray.inverse.y, pad);
    set(2, ray.origin.z, ray.inverse.z, pad);
  }

  // Where it enters each box; the bits name those it enters in [0, limit].
  [[gnu::always_inline]] unsigned enter(const BoxPlanes<T>& planes, T limit, B& near) const {
    near = B(T(0));
    B far = B(limit);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const B inverse(inverse_[axis]);
      near = max_first(near, multiply_subtract(planes[near_[axis]], inverse, B(near_offset_[axis])));
      far = min_first(far, multiply_subtract(planes[near_[axis] ^ 1], inverse, B(far_offset_[axis])));
    }
    return bits_of(near <= far * kFarther<T>);
  }

 private:
  void set(std::size_t axis, T origin, T inverse, T pad) {
    near_[axis] = 2 * axis + (inverse < 0);
    inverse_[axis] = inverse;
    near_offset_[axis] = origin * inverse + pad * std::abs(inverse);
    far_offset_[axis] = origin * inverse - pad * std::abs(inverse);
  }

  std::array<std::size_t, 3> near_;
  std::array<T, 3> inverse_, near_offset_, far_offset_;
};

// A register of rays that run alike: between the smallest and the largest of their origins and directions.
// What one of them enters, it enters.
template <class T>
class BeamProbe {
 public:
  using B = FanLanes<T>;
  using N = Lanes<T>;

  // Those of `active`. REQUIRES: any(active).
  BeamProbe(const Ray<N>& rays, const MaskOf<N>& active) {
    const T pad = largest(active, max_component(abs(rays.origin))) * kRounding<T>;
    set(0, active, rays.origin.x, rays.direction.x, pad);
    set(1, active, rays.origin.y, rays.direction.y, pad);
    set(2, active, rays.origin.z, rays.direction.z, pad);
  }

  // Whether the rays are so much alike that walking together pays.
  bool narrow() const { return narrow_; }

  [[gnu::always_inline]] unsigned enter(const BoxPlanes<T>& planes, T limit, B& near) const {
    near = B(T(0));
    B far = B(limit);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Axis& a = axis_[axis];
      const B in = planes[a.near] - B(a.near_origin), out = planes[a.near ^ 1] - B(a.far_origin);
      near = max_first(near, min_first(B(in * a.inverse_lo), B(in * a.inverse_hi)));
      far = min_first(far, max_first(B(out * a.inverse_lo), B(out * a.inverse_hi)));
    }
    return bits_of(near <= far * kFarther<T>);
  }

 private:
  struct Axis {
    std::size_t near;
    T inverse_lo, inverse_hi, near_origin, far_origin;
  };

  static T largest(const MaskOf<N>& active, const N& v) {
    return stdx::hmax(select(active, v, N(-std::numeric_limits<T>::infinity())));
  }
  static T smallest(const MaskOf<N>& active, const N& v) {
    return stdx::hmin(select(active, v, N(std::numeric_limits<T>::infinity())));
  }

  void set(std::size_t axis, const MaskOf<N>& active, const N& origin, const N& direction, T pad) {
    constexpr T kLeast = T(1e-18);
    const T lo = smallest(active, direction), hi = largest(active, direction);
    const bool negative = hi < 0;
    narrow_ = narrow_ && (lo > kLeast || hi < -kLeast) && hi - lo < T(0.25);
    const T origin_lo = smallest(active, origin) - pad, origin_hi = largest(active, origin) + pad;
    axis_[axis] = {2 * axis + negative, 1 / hi, 1 / lo, negative ? origin_lo : origin_hi,
                   negative ? origin_hi : origin_lo};
  }

  std::array<Axis, 3> axis_;
  bool narrow_ = true;
};

}  // namespace orrery
