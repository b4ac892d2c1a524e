#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/lanes.h"
#include "core/math/vec3.h"

// Batches: many rays in structure-of-arrays form, passed between stages. T is float or double (long double in
// reference tests). Arrays are aligned for whole registers and have kBatchRoom elements. A stage may
// therefore read and write past `count`, up to the next register boundary.
namespace orrery {

class MediaList;

inline constexpr int kBatch = 1024;                    // maximum rays per batch
inline constexpr int kBatchRoom = kBatch + 16;         // the widest register has 16 lanes
using MediaLists = std::array<MediaList, kBatchRoom>;  // by ray of a batch: see core/model/media.h

template <class T>
struct Array {
  alignas(64) std::array<T, kBatchRoom> values;

  T& operator[](int i) { return values[static_cast<std::size_t>(i)]; }
  const T& operator[](int i) const { return values[static_cast<std::size_t>(i)]; }
  // Returns the elements from i on as lanes. REQUIRES: i is a multiple of the lane count.
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

// Loads indices as wide as T, so that comparisons of indices and of T have the same mask type.
template <class T>
[[gnu::always_inline]] inline IndexLanes<T> load_index(const Array<IndexOf<T>>& a, int i) {
  return {&a.values[static_cast<std::size_t>(i)], stdx::vector_aligned};
}

// Registers of a batch that a stage processes. A register is stored as the index of its first ray, in
// ascending order.
class LaneGroups {
 public:
  LaneGroups() {}  // leaves first_ uninitialised

  // Returns all registers that contain rays `from` to `to` - 1. REQUIRES: `from` is a multiple of `width`.
  static LaneGroups covering(int from, int to, int width) {
    LaneGroups all;
    for (int i = from; i < to; i += width) all.add(i);
    return all;
  }
  static LaneGroups single(int first) {
    LaneGroups one;
    one.add(first);
    return one;
  }
  LaneGroups(const LaneGroups& other) { *this = other; }
  LaneGroups& operator=(const LaneGroups& other) {
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

// Ray of points origin + t * direction. Hit formulas accept any non-zero direction. Stages use unit
// directions, so that t is in metres.
template <class N>
struct Ray {
  Vec3<N> origin, direction;

  [[gnu::always_inline]] Vec3<N> at(const N& t) const { return origin + direction * t; }
};

// Rays of a batch. t_max is the exclusive far end in units of the direction's length. A ray with t_max <= 0
// is inactive and hits nothing.
template <class T>
struct RayBatch {
  int count = 0;
  Vec3Array<T> origin, direction;
  Array<T> t_max;
  Array<T> time;  // fraction of the exposure, in [0, 1); filled only if something moves during the exposure

  [[gnu::always_inline]] Ray<Lanes<T>> at(int i) const { return {origin.at(i), direction.at(i)}; }
  Ray<T> operator[](int i) const { return {origin[i], direction[i]}; }
  void set(int i, const Ray<T>& ray, T end) {
    origin.set(i, ray.origin);
    direction.set(i, ray.direction);
    t_max[i] = end;
  }
};

// Returns the number of active rays of `groups`.
template <class T>
std::uint64_t active_rays(const RayBatch<T>& rays, const LaneGroups& groups) {
  std::uint64_t count = 0;
  for (const int i : groups)
    count += static_cast<std::uint64_t>(stdx::popcount(rays.t_max.at(i) > Lanes<T>(T(0))));
  return count;
}
template <class T>
LaneGroups with_active_rays(const RayBatch<T>& rays, const LaneGroups& groups) {
  LaneGroups active;
  for (const int i : groups)
    if (any(rays.t_max.at(i) > Lanes<T>(T(0)))) active.add(i);
  return active;
}

inline constexpr int kNoPrimitive = -1;

// Optional hit data that the stages of a plan read, in addition to t, primitive, position, normals, side,
// step and material. Optional arrays that no stage reads are not filled.
struct SurfaceFields {
  bool parameters = false;  // u and v of hits and surfaces, tangent
  bool identity = false;    // instance of hits, object of surfaces
  bool footprint = false;   // width and spread of rays, footprint of surfaces
  bool travelled = false;   // distance of surfaces from the ray origin
  bool smooth = false;      // smooth normal and lift of surfaces
  bool color = false;       // colour of surfaces

  SurfaceFields& operator|=(const SurfaceFields& other) {
    parameters |= other.parameters;
    identity |= other.identity;
    footprint |= other.footprint;
    travelled |= other.travelled;
    smooth |= other.smooth;
    color |= other.color;
    return *this;
  }
};

// Nearest known hit of each ray. Initially, t is t_max and primitive is kNoPrimitive. find_surfaces()
// computes the other arrays once per ray after the search, because a search replaces most of the hits that it
// finds.
template <class T>
struct HitBatch {
  Array<T> t;
  Array<IndexOf<T>> primitive;
  Array<T> u, v;               // shape parameters; triangles: weights of the second and third vertex
  Array<IndexOf<T>> instance;  // instance of the primitive, counted from 0, or kNoInstance
};
inline constexpr int kNoInstance = -1;

// Returns the lanes in which the hit at t on primitive `id` replaces (best, best_id). A hit replaces a
// farther hit, or an equally near hit with a higher primitive number. NaN and infinity are not hits.
template <class N, class I>
[[gnu::always_inline]] inline MaskOf<N> is_nearer_hit(const N& t, const I& id, const N& best,
                                                      const I& best_id) {
  constexpr auto kFarthest = std::numeric_limits<ScalarOf<N>>::max();
  const auto lower = mask_cast<N>(id < best_id || best_id == I(kNoPrimitive));
  return t < best || (t == best && lower && t <= N(kFarthest));
}

// Surface at each hit. Normals are unit and point to the side that the ray came from.
template <class T>
struct SurfaceBatch {
  Vec3Array<T> position;   // corrected to lie on the shape
  Vec3Array<T> normal;     // for shading; may be interpolated
  Vec3Array<T> geometric;  // normal of the actual surface
  Array<T> side;           // +1: the ray came from outside, -1: from inside
  Array<T> step;           // metres along `geometric`, larger than the rounding error of the position
  Array<IndexOf<T>> material;
  // Optional arrays: see SurfaceFields.
  Vec3Array<T> tangent;      // unit, direction of increasing u, perpendicular to the geometric normal
  Array<T> u, v;             // texture coordinates of a mesh that has them, otherwise shape parameters
  Array<T> footprint;        // pixel width in metres, across the ray
  Array<T> travelled;        // metres from the ray's origin
  Array<IndexOf<T>> object;  // object number in the scene: `objects` first, then `instances`
  // Smooth triangles with opaque materials: the interpolated vertex normal before bumps, unit, and the vector
  // from `position` to the curved surface that the vertex normals imply (see ShapeKernel::smooth()), metres.
  // Other surfaces: `geometric` and 0.
  Vec3Array<T> smooth, lift;
  Vec3Array<T> color;  // interpolated vertex colour of a mesh that has them, otherwise 1
  // Index of refraction inside the surface, divided by the index outside. Null unless Plan::media: indices of
  // materials are then relative to air, and materials apply their filters. Otherwise the technique does.
  const Array<T>* relative_index = nullptr;
  // Bodies that contain the points just behind the surfaces. Null unless Plan::media.
  const MediaLists* behind = nullptr;
  // Values of textured parameters, by slot of TextureUse. Filled only in lanes whose material has such a
  // parameter. Empty if the scene uses no textures.
  std::vector<Vec3Array<T>> textured;
  // Emitted radiance. Filled only in lanes whose material has a texture of its emission.
  Vec3Array<T> emitted;

  // Returns the origins of rays along `direction` from the surfaces in register i. The origins are offset by
  // `step` to the side on which the rays leave.
  Vec3<Lanes<T>> origin_toward(int i, const Vec3<Lanes<T>>& direction) const {
    const Vec3<Lanes<T>> true_normal = geometric.at(i);
    const Lanes<T> clear = step.at(i);
    return position.at(i) +
           true_normal * select(dot(direction, true_normal) < Lanes<T>(T(0)), Lanes<T>(-clear), clear);
  }
};

}  // namespace orrery
