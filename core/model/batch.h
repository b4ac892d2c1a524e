#pragma once

#include <array>
#include <cstdint>

#include "core/math/lanes.h"
#include "core/math/vec3.h"

// Batches: many rays in structure-of-arrays form, passed between stages. T is float or double (long double in
// oracles). All arrays are aligned for whole registers and hold kBatchRoom entries, so that a stage may read
// and write past `count` up to the next register boundary.
namespace orrery {

inline constexpr int kBatch = 1024;             // rays a batch holds at most
inline constexpr int kBatchRoom = kBatch + 16;  // the widest register is 16 lanes

template <class T>
struct Array {
  alignas(64) std::array<T, kBatchRoom> values;

  T& operator[](int i) { return values[static_cast<std::size_t>(i)]; }
  const T& operator[](int i) const { return values[static_cast<std::size_t>(i)]; }
  // Lanes i, i+1, ...; REQUIRES: i is a multiple of the lane count.
  [[gnu::always_inline]] Lanes<T> at(int i) const requires std::is_floating_point_v<T> {
    return {&values[static_cast<std::size_t>(i)], stdx::vector_aligned};
  }
  template <class V>
  [[gnu::always_inline]] void put(int i, const V& v) {
    v.copy_to(&values[static_cast<std::size_t>(i)], stdx::vector_aligned);
  }
  template <class V, class M>
  [[gnu::always_inline]] void put(int i, const M& mask, const V& v) {
    stdx::where(mask, v).copy_to(&values[static_cast<std::size_t>(i)], stdx::vector_aligned);
  }
};

template <class T>
struct Vec3Array {
  Array<T> x, y, z;

  // One of them.
  Vec3<T> operator[](int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Vec3<T>& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }

  [[gnu::always_inline]] Vec3<Lanes<T>> at(int i) const { return {x.at(i), y.at(i), z.at(i)}; }
  [[gnu::always_inline]] void put(int i, const Vec3<Lanes<T>>& v) {
    x.put(i, v.x);
    y.put(i, v.y);
    z.put(i, v.z);
  }
  template <class M>
  [[gnu::always_inline]] void put(int i, const M& mask, const Vec3<Lanes<T>>& v) {
    x.put(i, mask, v.x);
    y.put(i, mask, v.y);
    z.put(i, mask, v.z);
  }
};

// Indices as wide as T, so that comparisons of the two share a mask.
template <class T>
[[gnu::always_inline]] inline IndexLanes<T> load_index(const Array<IndexOf<T>>& a, int i) {
  return {&a.values[static_cast<std::size_t>(i)], stdx::vector_aligned};
}

// The registers of a batch that a stage works on: index of each one's first ray, ascending.
class Groups {
 public:
  Groups() {}  // the list itself stays uninitialised

  // Every register that holds one of the rays from..to-1; `from` is a multiple of the width.
  static Groups covering(int from, int to, int width) {
    Groups all;
    for (int i = from; i < to; i += width) all.add(i);
    return all;
  }
  static Groups single(int first) {
    Groups one;
    one.add(first);
    return one;
  }
  Groups(const Groups& other) { *this = other; }
  Groups& operator=(const Groups& other) {
    count_ = other.count_;
    std::copy(other.begin(), other.end(), first_.begin());
    return *this;
  }
  void add(int first) { first_[static_cast<std::size_t>(count_++)] = static_cast<std::uint16_t>(first); }
  bool empty() const { return count_ == 0; }
  int size() const { return count_; }
  const std::uint16_t* begin() const { return first_.data(); }
  const std::uint16_t* end() const { return first_.data() + count_; }

 private:
  int count_ = 0;
  std::array<std::uint16_t, kBatch> first_;
};

// One ray: points origin + t * direction. Formulas for hits take any non-zero direction; the stages pass unit
// directions, so that t is metres.
template <class N>
struct Ray {
  Vec3<N> origin, direction;

  [[gnu::always_inline]] Vec3<N> at(const N& t) const { return origin + direction * t; }
};

// Rays of a batch. t_max is the far end in units of the direction's length (exclusive); a ray with t_max < 0
// is inactive: it hits nothing.
template <class T>
struct RayBatch {
  int count = 0;
  Vec3Array<T> origin, direction;
  Array<T> t_max;
  Array<T> time;  // share of the exposure, in [0, 1); filled only where something moves during one

  [[gnu::always_inline]] Ray<Lanes<T>> at(int i) const { return {origin.at(i), direction.at(i)}; }
  // One of them.
  Ray<T> operator[](int i) const { return {origin[i], direction[i]}; }
  void set(int i, const Ray<T>& ray, T end) {
    origin.set(i, ray.origin);
    direction.set(i, ray.direction);
    t_max[i] = end;
  }
};

// Rays of `groups` that are still active, and the registers that hold one.
template <class T>
std::uint64_t active_rays(const RayBatch<T>& rays, const Groups& groups) {
  std::uint64_t count = 0;
  for (const int i : groups)
    count += static_cast<std::uint64_t>(stdx::popcount(rays.t_max.at(i) > Lanes<T>(T(0))));
  return count;
}
template <class T>
Groups with_active_rays(const RayBatch<T>& rays, const Groups& groups) {
  Groups active;
  for (const int i : groups)
    if (any(rays.t_max.at(i) > Lanes<T>(T(0)))) active.add(i);
  return active;
}

inline constexpr int kNoPrimitive = -1;

// What the stages of a plan read of a hit beside t, primitive, position, normals, side, step and material.
// Arrays that no stage reads are not filled.
struct SurfaceFields {
  bool parameters = false;  // u and v of hits and surfaces, tangent
  bool identity = false;    // instance of hits, object of surfaces
  bool footprint = false;   // width and spread of rays, footprint of surfaces
  bool travelled = false;   // of surfaces

  SurfaceFields& operator|=(const SurfaceFields& other) {
    parameters |= other.parameters;
    identity |= other.identity;
    footprint |= other.footprint;
    travelled |= other.travelled;
    return *this;
  }
};

// Nearest hit so far of each ray: t starts as the ray's t_max, primitive as kNoPrimitive. The rest is derived
// from these two once per ray, after the search has ended (ShapeKernel::parameters()), because a search
// replaces most of the hits that it finds.
template <class T>
struct HitBatch {
  Array<T> t;
  Array<IndexOf<T>> primitive;
  Array<T> u, v;  // the shape's own parameters (of a triangle: weights of its second and third vertex)
  Array<IndexOf<T>> instance;  // that the primitive belongs to, counted from 0; kNoInstance for none
};
inline constexpr int kNoInstance = -1;

// Where a hit at t on primitive `id` takes the place of (best, best_id): it is nearer, or as near and of a
// lower number. Neither NaN nor infinity is a hit.
template <class N, class I>
[[gnu::always_inline]] inline MaskOf<N> takes_over(const N& t, const I& id, const N& best, const I& best_id) {
  constexpr auto kFarthest = std::numeric_limits<ScalarOf<N>>::max();
  const auto lower = mask_cast<N>(id < best_id || best_id == I(kNoPrimitive));
  return t < best || (t == best && lower && t <= N(kFarthest));
}

// The surface at each hit. Unit normals stand on the side the ray came from.
template <class T>
struct SurfaceBatch {
  Vec3Array<T> position;   // put back on the shape
  Vec3Array<T> normal;     // for shading; may be interpolated
  Vec3Array<T> geometric;  // of the true surface
  Array<T> side;           // +1: the ray came from the outside, -1: from the inside
  Array<T> step;           // metres along `geometric` that clear the surface of rounding
  Array<IndexOf<T>> material;
  // See SurfaceFields.
  Vec3Array<T> tangent;  // unit, along which u grows, at right angles to the true normal
  Array<T> u, v;         // texture coordinates: those of a mesh if it has any, else the shape's parameters
  Array<T> footprint;    // metres that a pixel covers here, across the ray
  Array<T> travelled;    // metres from the ray's origin
  Array<IndexOf<T>> object;  // number of the object in the scene: `objects` first, then `instances`

  // Where rays along these directions leave the surfaces at register i: on the side that they go to.
  Vec3<Lanes<T>> origin_toward(int i, const Vec3<Lanes<T>>& direction) const {
    const Vec3<Lanes<T>> true_normal = geometric.at(i);
    const Lanes<T> clear = step.at(i);
    return position.at(i) +
           true_normal * select(dot(direction, true_normal) < Lanes<T>(T(0)), Lanes<T>(-clear), clear);
  }
};

}  // namespace orrery
