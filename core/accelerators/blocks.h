#pragma once

#include <algorithm>
#include <cassert>
#include <span>

#include "core/base/error.h"
#include "core/model/accelerator.h"

namespace orrery {

// Name of a block of packed primitives. Bits 0 to 25 are the index of the block in its pack, bits 26 to 30
// the index of the pack. A pack contains the primitives of one kernel. The highest bit is free for the
// structure. A scene has one kernel per shape type and one for instances, so 5 bits suffice for 31 shape
// types.
using BlockName = std::uint32_t;

// Primitives of a structure in traversal order, packed into blocks of kBlock<T>.
template <class T>
class Blocks {
 public:
  static constexpr std::size_t kSize = static_cast<std::size_t>(kBlock<T>);
  static std::size_t pack_number(BlockName name) { return name >> kBlockBits & (kMaxPacks - 1); }
  static std::uint32_t block_of(BlockName name) { return name & kBlockMask; }

  // Adds a block of 1 to kSize primitives of one kernel. `places` contains their indices in `primitives`.
  // Returns the name of the block. Throws InputError if the kernel has more than 2^26 blocks.
  BlockName add(const PrimitiveList<T>& primitives, std::span<const std::uint32_t> places) {
    const auto* kernel = primitives[places.front()].kernel;
    references_ += places.size();
    auto making = std::find_if(partial_packs_.begin(), partial_packs_.end(),
                               [kernel](const PartialPack& m) { return m.kernel == kernel; });
    if (making == partial_packs_.end()) making = partial_packs_.insert(making, {kernel, places.front(), {}});
    assert(partial_packs_.size() <= kMaxPacks);
    std::vector<int>& indices = making->indices;
    const auto block = static_cast<std::uint32_t>(indices.size() / kSize);
    if (block > kBlockMask)
      throw InputError("/render/accelerator",
                       "structure has more than 67,108,864 blocks of primitives (limit 67,108,864)");
    for (const std::uint32_t place : places) indices.push_back(primitives[place].index);
    indices.resize((block + 1) * kSize, kNothing);
    return static_cast<BlockName>(making - partial_packs_.begin()) << kBlockBits | block;
  }
  // Adds the primitives at `places` in as few blocks as possible. Appends the block names to `names`.
  // REQUIRES: `places` is in ascending order, so that primitives of one kernel are adjacent.
  void add_all(const PrimitiveList<T>& primitives, std::span<const std::uint32_t> places,
               std::vector<BlockName>& names) {
    while (!places.empty()) {
      const auto* kernel = primitives[places.front()].kernel;
      std::size_t count = 1;
      while (count < std::min(kSize, places.size()) && primitives[places[count]].kernel == kernel) ++count;
      names.push_back(add(primitives, places.first(count)));
      places = places.subspan(count);
    }
  }
  // Packs the blocks. Must be called after the last block is added and before any block is read.
  void pack() {
    for (const PartialPack& making : partial_packs_)
      packs_.push_back({making.kernel, making.place, making.kernel->pack(making.indices)});
    partial_packs_ = {};
  }

  // Repacks the primitives from `moved`, which has the order of the original list. Returns the new boxes of
  // all blocks, indexed by pack and block. The list of boxes of a pack is empty if the primitives of the pack
  // have not moved.
  std::vector<std::vector<Bounds<T>>> follow(const PrimitiveList<T>& moved) {
    std::vector<std::vector<Bounds<T>>> boxes;
    for (Pack& pack : packs_) {
      auto& of_pack = boxes.emplace_back();
      const auto* kernel = moved[pack.place].kernel;
      if (kernel == pack.kernel) continue;
      const std::vector<int> indices = pack.primitives->indices();
      const std::vector<const Boundsd*> bounds = bounds_of(*kernel, moved);
      pack.primitives = kernel->pack(indices);
      pack.kernel = kernel;
      of_pack.resize(indices.size() / kSize);
      for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] != kNothing)
          of_pack[i / kSize].include(padded<T>(*bounds[static_cast<std::size_t>(indices[i])]));
    }
    return boxes;
  }

  bool empty() const { return packs_.empty(); }
  std::size_t references() const { return references_; }
  const PackedPrimitives<T>& pack_of(BlockName name) const { return *packs_[pack_number(name)].primitives; }
  std::size_t bytes() const {
    std::size_t bytes = 0;
    for (const Pack& pack : packs_) bytes += pack.primitives->bytes();
    return bytes;
  }

 private:
  static constexpr int kBlockBits = 26;
  static constexpr std::uint32_t kBlockMask = (1u << kBlockBits) - 1, kMaxPacks = 1u << 5;
  // Returns the bounds of a kernel's primitives, indexed like the kernel. An entry is null if the primitive
  // is not in the list.
  static std::vector<const Boundsd*> bounds_of(const ShapeKernel<T>& kernel,
                                               const PrimitiveList<T>& primitives) {
    std::vector<const Boundsd*> bounds;
    for (const Primitive<T>& primitive : primitives) {
      if (primitive.kernel != &kernel) continue;
      const auto index = static_cast<std::size_t>(primitive.index);
      if (index >= bounds.size()) bounds.resize(index + 1);
      bounds[index] = &primitive.bounds;
    }
    return bounds;
  }

  // Pack under construction.
  struct PartialPack {
    const ShapeKernel<T>* kernel;
    std::size_t place;  // index of one primitive of the pack in the PrimitiveList
    std::vector<int> indices;
  };
  struct Pack {
    const ShapeKernel<T>* kernel;
    std::size_t place;
    PackedPrimitivesPtr<T> primitives;
  };
  std::vector<PartialPack> partial_packs_;
  std::vector<Pack> packs_;
  std::size_t references_ = 0;
};

}  // namespace orrery
