#pragma once

#include <bit>
#include <vector>

#include "core/base/prefetch.h"
#include "core/base/task_scope.h"
#include "core/math/compress.h"
#include "core/model/record.h"
#include "core/model/shape.h"

namespace orrery {

// Part of a record that distance() needs: its Core if it defines that type, else the whole record.
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

// Implementation of PackedPrimitives. Calls Core::distance() with a SingleRay or a Packet if Core has this
// overload, else with a plain Ray.
template <template <class> class Record, class T>
class PackedRecords final : public PackedPrimitives<T> {
 public:
  // Packs records.core(i) for each index i. REQUIRES: `indices` fill whole blocks, and no block is empty.
  template <class Records>
  PackedRecords(const Records& records, int first, std::span<const int> indices) : first_(first) {
    blocks_.reserve(indices.size() / kB);
    for (; indices.size() >= kB; indices = indices.subspan(kB)) {
      checkpoint(blocks_.size());
      fill(blocks_.emplace_back(), records, first, indices.first(kB));
    }
  }

  using RayBlockPairs = typename PackedPrimitives<T>::RayBlockPairs;

  [[gnu::flatten]] void closest(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
                                AcceleratorCounts& counts) const override {
    std::uint64_t tested = 0;
    for (const RayBlockPair& pair : pairs) {
      const Block& block = blocks_[pair.block];
      tested += block.count;
      SingleHit<T>& hit = hits[pair.ray];
      const B t = distance(block.core, rays[pair.ray]);
      const unsigned reached = bits_of(t <= B(std::min(hit.t, kFar))) & block.filled();
      if (reached != 0) take_nearest(block, t, reached, hit);
    }
    counts.primitive_tests += tested;
  }

  [[gnu::flatten]] void occlude(RayBlockPairs pairs, const SingleRay<T>* rays, SingleHit<T>* hits,
                                AcceleratorCounts& counts) const override {
    std::uint64_t tested = 0;
    for (const RayBlockPair& pair : pairs) {
      const Block& block = blocks_[pair.block];
      SingleHit<T>& hit = hits[pair.ray];
      if (hit.t < 0) continue;
      tested += block.count;
      if ((bits_of(distance(block.core, rays[pair.ray]) < B(hit.t)) & block.filled()) != 0) hit.t = T(-1);
    }
    counts.primitive_tests += tested;
  }

  [[gnu::flatten]] void closest(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                                AcceleratorCounts& counts) const override {
    std::uint64_t tested = 0;
    for (const RayBlockPair& pair : pairs) {
      const Block& block = blocks_[pair.block];
      PacketHit<T>& hit = hits[pair.ray];
      tested += block.count * active_in(hit);
      for_each(block, packets[pair.ray], hit.budget, [&](const Core<T>& core, IndexOf<T> id) {
        const N t = distance(core, packets[pair.ray]);
        if (!any(t <= min_first(hit.t, N(kFar)))) return;
        const auto nearer = is_nearer_hit(t, IndexLanes<T>(id), hit.t, hit.primitive);
        stdx::where(nearer, hit.t) = t;
        stdx::where(mask_cast<IndexLanes<T>>(nearer), hit.primitive) = IndexLanes<T>(id);
      });
      hit.farthest = stdx::hmax(hit.t);
    }
    counts.primitive_tests += tested;
  }

  [[gnu::flatten]] void occlude(RayBlockPairs pairs, const Packet<T>* packets, PacketHit<T>* hits,
                                AcceleratorCounts& counts) const override {
    std::uint64_t tested = 0;
    for (const RayBlockPair& pair : pairs) {
      const Block& block = blocks_[pair.block];
      PacketHit<T>& hit = hits[pair.ray];
      if (hit.farthest < 0) continue;
      tested += block.count * active_in(hit);
      for_each(block, packets[pair.ray], hit.budget, [&](const Core<T>& core, IndexOf<T>) {
        stdx::where(distance(core, packets[pair.ray]) < hit.t, hit.t) = N(T(-1));
      });
      hit.farthest = stdx::hmax(hit.t);
    }
    counts.primitive_tests += tested;
  }

  void prefetch(std::uint32_t block) const override { prefetch_lines(blocks_[block]); }
  std::size_t bytes() const override { return blocks_.size() * sizeof(Block); }

  std::vector<int> indices() const override {
    std::vector<int> indices;
    indices.reserve(blocks_.size() * kB);
    for (const Block& block : blocks_)
      for (std::size_t place = 0; place < kB; ++place)
        indices.push_back(place < block.count ? static_cast<int>(block.id[place]) - first_ : kNothing);
    return indices;
  }

 private:
  using N = Lanes<T>;
  using B = BlockLanes<T>;
  template <class M>
  using Core = typename CoreOf<Record, M>::type;
  static constexpr T kFar = std::numeric_limits<T>::max();  // largest distance of a hit
  static constexpr std::size_t kB = static_cast<std::size_t>(kBlock<T>);
  static constexpr std::size_t kCoreFields = sizeof(Core<T>) / sizeof(T);

  struct Block {
    Core<B> core;  // empty lanes repeat the last filled one
    std::array<IndexOf<T>, kB> id;
    unsigned count;  // number of filled lanes; they precede the empty lanes
    unsigned filled() const { return (1u << count) - 1u; }
  };

  template <class Records>
  static void fill(Block& block, const Records& records, int first, std::span<const int> indices) {
    block.count = 0;
    std::array<std::array<T, kB>, kCoreFields> columns;
    for (const int index : indices) {
      if (index == kNothing) continue;
      const auto lane = static_cast<std::size_t>(block.count++);
      std::array<T, kCoreFields> row;
      const auto& core = records.core(static_cast<std::size_t>(index));
      std::memcpy(row.data(), &core, sizeof row);
      for (std::size_t field = 0; field < kCoreFields; ++field) columns[field][lane] = row[field];
      block.id[lane] = static_cast<IndexOf<T>>(first + index);
    }
    for (std::size_t last = block.count - 1, rest = block.count; rest < kB; ++rest) {
      for (auto& column : columns) column[rest] = column[last];
      block.id[rest] = block.id[last];
    }
    static_assert(sizeof columns == sizeof block.core);
    std::memcpy(static_cast<void*>(&block.core), columns.data(), sizeof columns);
  }

  static B distance(const Core<B>& core, const SingleRay<T>& single) {
    if constexpr (requires { core.distance(single); })
      return core.distance(single);
    else
      return core.distance(Ray<B>{Vec3<B>(single.ray.origin), Vec3<B>(single.ray.direction)});
  }
  // Returns the distance along each ray of the packet to one primitive.
  [[gnu::always_inline]] static N distance(const Core<T>& core, const Packet<T>& packet) {
    if constexpr (requires { core.distance(packet); }) {
      return core.distance(packet);
    } else {
      std::array<T, kCoreFields> row;
      std::memcpy(row.data(), &core, sizeof row);
      std::array<N, kCoreFields> lanes;
      for (std::size_t field = 0; field < kCoreFields; ++field) lanes[field] = N(row[field]);
      Core<N> wide;
      std::memcpy(static_cast<void*>(&wide), lanes.data(), sizeof wide);
      return wide.distance(packet.ray);
    }
  }

  static unsigned active_in(const PacketHit<T>& hit) {
    return static_cast<unsigned>(stdx::popcount(hit.t > N(T(0))));
  }

  // Replaces `hit` by the nearest hit of the lanes `reached`. Equal distances go to the lower primitive
  // number. REQUIRES: t <= hit.t in these lanes.
  static void take_nearest(const Block& block, const B& t, unsigned reached, SingleHit<T>& hit) {
    for (; reached != 0; reached &= reached - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(reached));
      const T t_lane = t[lane];
      const bool lower = block.id[lane] < hit.primitive || hit.primitive == kNoPrimitive;
      if (t_lane < hit.t || (t_lane == hit.t && lower)) hit = {t_lane, block.id[lane]};
    }
  }

  // Calls visit(core, primitive number) for each primitive that the packet may hit. Subtracts 1 for the block
  // and 1 for each of these primitives from `budget`.
  template <class Visit>
  [[gnu::always_inline]] static void for_each(const Block& block, const Packet<T>& packet, int& budget,
                                              const Visit& visit) {
    unsigned chosen = block.filled();
    if constexpr (requires { block.core.may_meet(packet); }) chosen &= bits_of(block.core.may_meet(packet));
    budget -= 1 + std::popcount(chosen);
    for (; chosen != 0; chosen &= chosen - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(chosen));
      std::array<T, kCoreFields> row;
      for (std::size_t field = 0; field < kCoreFields; ++field)
        std::memcpy(&row[field], reinterpret_cast<const T*>(&block.core) + field * kB + k, sizeof(T));
      Core<T> core;
      std::memcpy(static_cast<void*>(&core), row.data(), sizeof core);
      visit(core, block.id[k]);
    }
  }

  const int first_;
  std::vector<Block> blocks_;
};

}  // namespace orrery
