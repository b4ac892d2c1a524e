#pragma once

#include <bit>
#include <vector>

#include "core/math/compress.h"
#include "core/model/record.h"
#include "core/model/shape.h"

namespace orrery {

// The part of a record that distance() needs: what it names as Core, or all of it.
template <template <class> class Record, class N>
struct CoreOf {
  using type = Record<N>;
  static const type& of(const Record<N>& record) { return record; }
};
template <template <class> class Record, class N>
requires requires { typename Record<N>::Core; }
struct CoreOf<Record, N> {
  using type = typename Record<N>::Core;
  static const type& of(const Record<N>& record) { return record.core(); }
};

// See PackedPrimitives. A core that has a distance() for a LoneRay is asked that way, others see the ray in
// every lane.
template <template <class> class Record, class T>
class PackedRecords final : public PackedPrimitives<T> {
 public:
  PackedRecords(std::span<const Record<T>> records, int first, std::span<const int> indices) {
    blocks_.resize(indices.size() / kB);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      fill(blocks_[b], records, first, indices.subspan(b * kB, kB));
  }

  [[gnu::flatten]] int closest(std::uint32_t first, std::uint32_t last, const LoneRay<T>& ray,
                               LoneHit<T>& hit) const override {
    int tested = 0;
    for (std::uint32_t b = first; b < last; ++b) {
      const Block& block = blocks_[b];
      tested += block.count;
      const B t = distance(block.core, ray);
      const unsigned reached = bits_of(t <= B(hit.t)) & block.filled();
      if (reached == 0) continue;
      take_nearest(block, t, reached, hit);
    }
    return tested;
  }

  [[gnu::flatten]] int occlude(std::uint32_t first, std::uint32_t last, const LoneRay<T>& ray,
                               T& t_max) const override {
    int tested = 0;
    for (std::uint32_t b = first; b < last; ++b) {
      const Block& block = blocks_[b];
      tested += block.count;
      if ((bits_of(distance(block.core, ray) < B(t_max)) & block.filled()) == 0) continue;
      t_max = T(-1);
      break;
    }
    return tested;
  }

  [[gnu::flatten]] int closest(std::uint32_t first, std::uint32_t last, const RayBatch<T>& rays, int group,
                               HitBatch<T>& hits) const override {
    const Ray<N> ray = rays.at(group);
    N best = hits.t.at(group);
    IndexLanes<T> best_id = load_index<T>(hits.primitive, group);
    const int tested = for_each(first, last, [&](const Core<N>& core, IndexOf<T> id) {
      const N t = core.distance(ray);
      if (!any(t <= best)) return;
      const auto lower = mask_cast<N>(IndexLanes<T>(id) < best_id || best_id == kNoPrimitive);
      const auto nearer = t < best || (t == best && lower && t < std::numeric_limits<T>::infinity());
      stdx::where(nearer, best) = t;
      stdx::where(mask_cast<IndexLanes<T>>(nearer), best_id) = IndexLanes<T>(id);
    });
    hits.t.put(group, best);
    hits.primitive.put(group, best_id);
    return tested;
  }

  [[gnu::flatten]] int occlude(std::uint32_t first, std::uint32_t last, RayBatch<T>& rays,
                               int group) const override {
    const Ray<N> ray = rays.at(group);
    N t_max = rays.t_max.at(group);
    const int tested = for_each(first, last, [&](const Core<N>& core, IndexOf<T>) {
      stdx::where(core.distance(ray) < t_max, t_max) = N(T(-1));
    });
    rays.t_max.put(group, t_max);
    return tested;
  }

  std::size_t bytes() const override { return blocks_.size() * sizeof(Block); }

 private:
  using N = Lanes<T>;
  using B = BlockLanes<T>;
  template <class M>
  using Core = typename CoreOf<Record, M>::type;
  static constexpr std::size_t kB = static_cast<std::size_t>(kBlock<T>);
  static constexpr std::size_t kCoreFields = sizeof(Core<T>) / sizeof(T);

  struct Block {
    Core<B> core;  // empty places repeat another
    std::array<IndexOf<T>, kB> id;
    int count;  // filled places, which come first
    unsigned filled() const { return (1u << count) - 1u; }
  };

  static void fill(Block& block, std::span<const Record<T>> records, int first,
                   std::span<const int> indices) {
    block.count = 0;
    std::array<std::array<T, kB>, kCoreFields> columns;
    for (const int index : indices) {
      if (index == kNothing) continue;
      const auto lane = static_cast<std::size_t>(block.count++);
      std::array<T, kCoreFields> row;
      std::memcpy(row.data(), &CoreOf<Record, T>::of(records[static_cast<std::size_t>(index)]), sizeof row);
      for (std::size_t rest = lane; rest < kB; ++rest) {
        for (std::size_t field = 0; field < kCoreFields; ++field) columns[field][rest] = row[field];
        block.id[rest] = static_cast<IndexOf<T>>(first + index);
      }
    }
    static_assert(sizeof columns == sizeof block.core);
    std::memcpy(static_cast<void*>(&block.core), columns.data(), sizeof columns);
  }

  static B distance(const Core<B>& core, const LoneRay<T>& ray) {
    if constexpr (requires { core.distance(ray); })
      return core.distance(ray);
    else
      return core.distance(Ray<B>{Vec3<B>(ray.origin), Vec3<B>(ray.direction)});
  }

  // Of the lanes `reached`, which lie at hit.t or nearer, the nearest one with the lowest number.
  static void take_nearest(const Block& block, const B& t, unsigned reached, LoneHit<T>& hit) {
    for (; reached != 0; reached &= reached - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(reached));
      const T t_lane = t[lane];
      const bool lower = block.id[lane] < hit.primitive || hit.primitive == kNoPrimitive;
      if (t_lane < hit.t || (t_lane == hit.t && lower && t_lane < std::numeric_limits<T>::infinity()))
        hit = {t_lane, block.id[lane]};
    }
  }

  // Calls `visit` with the core of each primitive in every lane, and its number.
  template <class Visit>
  int for_each(std::uint32_t first, std::uint32_t last, const Visit& visit) const {
    int tested = 0;
    for (std::uint32_t b = first; b < last; ++b) {
      const Block& block = blocks_[b];
      tested += block.count;
      for (std::size_t k = 0; k < static_cast<std::size_t>(block.count); ++k) {
        std::array<N, kCoreFields> lanes;
        for (std::size_t field = 0; field < kCoreFields; ++field) {
          T value;
          std::memcpy(&value, reinterpret_cast<const T*>(&block.core) + field * kB + k, sizeof value);
          lanes[field] = N(value);
        }
        Core<N> core;
        std::memcpy(static_cast<void*>(&core), lanes.data(), sizeof core);
        visit(core, block.id[k]);
      }
    }
    return tested;
  }

  std::vector<Block> blocks_;
};

}  // namespace orrery
