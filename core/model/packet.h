#pragma once

#include <array>
#include <cstdint>

#include "core/model/batch.h"

// Rays as structures meet them: one alone among many primitives (SingleRay), or a register of them that run
// alike, so that they walk together (Packet); each with what its tests need and share worked out once.
namespace orrery {

// Work of a structure: one ray against one thing, whatever the width of the lanes.
struct AcceleratorCounts {
  std::uint64_t node_visits = 0;  // by a ray, or by several that walk together
  std::uint64_t box_tests = 0;
  std::uint64_t primitive_tests = 0;
  std::uint64_t proposals = 0;  // primitives held against a shadow ray before the structure was asked
  std::uint64_t proofs = 0;     // those that it met

  void add(const AcceleratorCounts& other) {
    node_visits += other.node_visits;
    box_tests += other.box_tests;
    primitive_tests += other.primitive_tests;
    proposals += other.proposals;
    proofs += other.proofs;
  }
};

// The axes of a ray as masks: z the direction's largest component, x and y following it cyclically.
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

// Places of x, y and z in a vector, by the place of z.
inline constexpr std::array<std::array<int, 3>, 3> kCyclicAxes{{{1, 2, 0}, {2, 0, 1}, {0, 1, 2}}};

// What a ray has for being turned and sheared to run along its largest axis z: x and y per z, and z.
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
  std::array<int, 3> axis;  // places of x, y and z
  Shear<T> shear;

  static SingleRay of(const Ray<T>& ray) {
    const RayAxes<T> axes(ray.direction);
    return {ray, kCyclicAxes[axes.z_is_x ? 0 : axes.z_is_y ? 1 : 2], Shear<T>::of(axes, ray.direction)};
  }
};

template <class T>
struct Packet {
  Ray<Lanes<T>> ray;
  std::array<int, 3> axis;  // the same for all that are active
  Shear<Lanes<T>> shear;
  // What the active ones have in common: their origin, if it is one, and the limits of shear.x and shear.y.
  bool one_origin;
  Vec3<T> origin;
  std::array<T, 2> shear_lo, shear_hi;
};

// Nearest hit so far: t starts as the ray's t_max, primitive as kNoPrimitive. An occluded ray has t -1.
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
  T farthest;  // of t
  int budget;  // tests of blocks and primitives that are left to it; below 0, it enters nothing any more

  T limit() const { return budget < 0 ? T(-1) : farthest; }
};

// One of the rays, or packets, and a block of primitives that it has to be tested with.
struct RayBlockPair {
  std::uint32_t block;
  std::int32_t ray;
};

}  // namespace orrery
