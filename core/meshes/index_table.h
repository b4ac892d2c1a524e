#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "core/base/task_scope.h"

namespace orrery {

// Hash table that maps the contents of list entries to their indices 0, 1, 2, ... The caller stores the list.
// Uses open addressing with a load factor of at most 1/2. The hash has a random key, so that a crafted file
// cannot force collisions. Indices do not depend on the key. Not thread-safe. find_or_add() throws Cancelled.
class IndexTable {
 public:
  // Returns the hash of `words`, which differs between tables.
  std::uint32_t hash(std::span<const std::uint64_t> words) const {
    std::uint64_t h = key_;
    for (const std::uint64_t word : words) h = mix(h ^ word);
    return static_cast<std::uint32_t>(h);
  }

  // Returns the index i of the entry with this hash for which same(i) is true. If no entry matches, adds an
  // entry with index `size` and returns `size`. The caller must then append the entry to the list. REQUIRES:
  // `size` is the current number of entries, below 2^31.
  template <class Same>
  std::uint32_t find_or_add(std::uint32_t hash, std::size_t size, const Same& same) {
    checkpoint();
    if (2 * (size + 1) > slots_.size()) grow();
    std::size_t at = first_slot(hash);
    for (; slots_[at].entry != kNone; at = (at + 1) & (slots_.size() - 1))
      if (slots_[at].hash == hash && same(slots_[at].entry)) return slots_[at].entry;
    slots_[at] = {static_cast<std::uint32_t>(size), hash};
    return slots_[at].entry;
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Slot {
    std::uint32_t entry = kNone;
    std::uint32_t hash = 0;
  };
  __extension__ using Wide = unsigned __int128;

  // Multiplies by a secret factor and combines both halves of the product (the mixing step of wyhash, Wang
  // Yi).
  std::uint64_t mix(std::uint64_t x) const {
    const auto product = static_cast<Wide>(x) * factor_;
    return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
  }
  static std::uint64_t random_word() {
    std::random_device device;
    return std::uint64_t{device()} << 32 | device();
  }

  std::size_t first_slot(std::uint32_t hash) const { return hash & (slots_.size() - 1); }
  void grow() {
    std::vector<Slot> old(std::max<std::size_t>(64, 2 * slots_.size()));
    std::swap(old, slots_);
    for (const Slot& slot : old) {
      if (slot.entry == kNone) continue;
      std::size_t at = first_slot(slot.hash);
      while (slots_[at].entry != kNone) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = slot;
    }
  }

  std::uint64_t key_ = random_word(), factor_ = random_word() | 1;
  std::vector<Slot> slots_;  // the size is 0 or a power of two
};

}  // namespace orrery
