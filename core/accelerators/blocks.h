#pragma once

#include <algorithm>
#include <span>

#include "core/model/accelerator.h"

namespace orrery {

// A block of packed primitives of one kernel: which pack (5 bits) and which block of it (26 bits). The
// highest bit is free for a structure's own use.
using BlockName = std::uint32_t;

// Primitives in the order that a structure chose, packed in blocks of kBlock<T>.
template <class T>
class Blocks {
 public:
  static constexpr std::size_t kSize = static_cast<std::size_t>(kBlock<T>);
  static std::size_t pack_number(BlockName name) { return name >> kBlockBits & 31u; }
  static std::uint32_t block_of(BlockName name) { return name & kBlockMask; }

  // Adds a block of 1 to kSize primitives of one kernel, named by their places in `primitives`.
  BlockName add(const PrimitiveList<T>& primitives, std::span<const std::uint32_t> places) {
    const auto* kernel = primitives[places.front()].kernel;
    auto making = std::find_if(makings_.begin(), makings_.end(),
                               [kernel](const Making& m) { return m.kernel == kernel; });
    if (making == makings_.end()) making = makings_.insert(making, {kernel, {}});
    std::vector<int>& indices = making->indices;
    const auto block = static_cast<std::uint32_t>(indices.size() / kSize);
    for (const std::uint32_t place : places) indices.push_back(primitives[place].index);
    indices.resize((block + 1) * kSize, kNothing);
    return static_cast<BlockName>(making - makings_.begin()) << kBlockBits | block;
  }
  // To be called once all are added, before any is asked for.
  void pack() {
    for (const Making& making : makings_) packs_.push_back(making.kernel->pack(making.indices));
    makings_ = {};
  }

  bool empty() const { return packs_.empty(); }
  const PackedPrimitives<T>& pack_of(BlockName name) const { return *packs_[pack_number(name)]; }
  std::size_t bytes() const {
    std::size_t bytes = 0;
    for (const auto& pack : packs_) bytes += pack->bytes();
    return bytes;
  }

 private:
  static constexpr int kBlockBits = 26;
  static constexpr std::uint32_t kBlockMask = 0x03ffffffu;
  // A pack that is being put together.
  struct Making {
    const ShapeKernel<T>* kernel;
    std::vector<int> indices;
  };
  std::vector<Making> makings_;
  std::vector<PackedPrimitivesPtr<T>> packs_;
};

}  // namespace orrery
