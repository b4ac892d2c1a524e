#pragma once

#include <array>
#include <cstdint>

#include "core/model/batch.h"

// Rays for traversal: one ray (SingleRay), or a register of similar rays that are traversed together
// (Packet). Both store values that intersection tests need and that are computed once per ray.
namespace orrery {

// Counters of an acceleration structure. Tests are counted per ray, independently of SIMD width.
struct AcceleratorCounts {
  std::uint64_t node_visits = 0;  // nodes visited; a packet counts as one visit
  std::uint64_t box_tests = 0;
  std::uint64_t primitive_tests = 0;
  std::uint64_t predicted_occluders = 0;  // tests of shadow rays against predicted occluders
  std::uint64_t verified_occluders = 0;   // tests of predicted occluders that hit

  void add(const AcceleratorCounts& other) {
    node_visits += other.node_visits;
    box_tests += other.box_tests;
    primitive_tests += other.primitive_tests;
    predicted_occluders += other.predicted_occluders;
    verified_occluders += other.verified_occluders;
  }
};

// Axes of a ray as masks. z is the axis of the largest component of the direction. x and y follow cyclically.
template <class N>
struct RayAxes {
  MaskOf<N> z_is_x, z_is_y, z_is_z;

  [[gnu::always_inline]] explicit RayAxes(const Vec3<N>& direction) {
    const Vec3<N> size = abs(direction);
    z_is_x = size.x >= size.y && size.x >= size.z;
    z_is_y = !z_is_x && size.y >= size.z;
    z_is_z = !z_is_x && !z_is_y;
  }
  [[gnu::always_inline]] N x(const Vec3<N>& v) const { return select(z_is_z, v.x, select(z_is_x, v.y, v.z)); }
  [[gnu::always_inline]] N y(const Vec3<N>& v) const { return select(z_is_y, v.x, select(z_is_z, v.y, v.z)); }
  [[gnu::always_inline]] N z(const Vec3<N>& v) const { return select(z_is_x, v.x, select(z_is_y, v.y, v.z)); }
};

// Vector indices of x, y and z, by the index of z.
inline constexpr std::array<std::array<int, 3>, 3> kCyclicAxes{{{1, 2, 0}, {2, 0, 1}, {0, 1, 2}}};

// Shear that aligns a ray with its largest axis z: x / z, y / z, and z.
template <class N>
struct Shear {
  N x, y, z;

  [[gnu::always_inline]] static Shear of(const RayAxes<N>& axes, const Vec3<N>& direction) {
    const N z = axes.z(direction);
    return {axes.x(direction) / z, axes.y(direction) / z, z};
  }
};

template <class T>
struct SingleRay {
  Ray<T> ray;
  std::array<int, 3> axis;  // vector indices of x, y and z
  Shear<T> shear;

  static SingleRay of(const Ray<T>& ray) {
    const RayAxes<T> axes(ray.direction);
    return {ray, kCyclicAxes[axes.z_is_x ? 0 : axes.z_is_y ? 1 : 2], Shear<T>::of(axes, ray.direction)};
  }
};

template <class T>
struct Packet {
  Ray<Lanes<T>> ray;
  std::array<int, 3> axis;  // vector indices of x, y and z, the same for all active rays
  Shear<Lanes<T>> shear;
  // Common origin of the active rays (valid if one_origin), and the ranges of shear.x and shear.y.
  bool one_origin;
  Vec3<T> origin;
  std::array<T, 2> shear_lo, shear_hi;
};

// Nearest known hit. Initially, t is t_max and primitive is kNoPrimitive. t is -1 if the ray is occluded.
template <class T>
struct SingleHit {
  T t;
  IndexOf<T> primitive;

  T limit() const { return t; }
};

template <class T>
struct PacketHit {
  Lanes<T> t;
  IndexLanes<T> primitive;
  T farthest;  // largest t
  int budget;  // remaining tests of blocks and primitives; below 0, traversal of the packet stops

  T limit() const { return budget < 0 ? T(-1) : farthest; }
};

// Index of a block of primitives, and index of the ray or packet to test against the block.
struct RayBlockPair {
  std::uint32_t block;
  std::int32_t ray;
};

}  // namespace orrery
