#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "core/accelerators/exhaustive.h"
#include "core/accelerators/wide_tree.h"

namespace orrery {

// Array whose elements stay uninitialised until put().
template <class X, int kMost>
class Slots {
 public:
  static_assert(std::is_trivially_destructible_v<X> && std::is_trivially_copyable_v<X>);
  Slots() {}
  void put(int i, const X& x) { std::construct_at(data() + i, x); }
  X* data() { return items_.data(); }
  X& operator[](int i) { return items_[static_cast<std::size_t>(i)]; }

 private:
  union {
    std::array<X, static_cast<std::size_t>(kMost)> items_;
  };
};

// Rays or packets that traverse a tree together, with their box testers and hits.
template <class RaysOf, class ProbeOf, class HitOf, int kMost>
struct TraversalGroup {
  static constexpr int kCapacity = kMost;
  Slots<RaysOf, kMost> rays;
  Slots<ProbeOf, kMost> probes;
  Slots<HitOf, kMost> hits;
  Slots<int, kMost> place;  // index in the batch
  int count = 0;

  void add(const RaysOf& ray, const ProbeOf& probe, const HitOf& hit, int at) {
    rays.put(count, ray);
    probes.put(count, probe);
    hits.put(count, hit);
    place.put(count++, at);
  }
};

// Ray stream traversal: opens each node once for all rays that enter it. This gives long SIMD loops and few
// mispredicted branches (Tsakok, "Faster Incoherent Rays: Multi-BVH Ray Stream Tracing", HPG 2009). For
// Query::closest, children are visited in the order of the smallest entry distance over all rays in the node.
template <Query kQuery, class T, class Traversals>
class Stream {
 public:
  Stream(const WideTree<T>& tree, Traversals& traversals, AcceleratorCounts& counts)
      : tree_(tree), traversals_(traversals), counts_(counts), far_(tree.bytes() > kNear) {}

  // Runs the traversals with the indices ids[0] to ids[count - 1]. REQUIRES: kPad elements after the last
  // index are readable.
  static constexpr int kPad = 16;
  void run(const std::int32_t* ids, int count) { visit(tree_.root(), ids, count, count, room_.data()); }

 private:
  using Id = stdx::native_simd<std::int32_t>;
  using Child = typename WideTree<T>::Child;
  static constexpr std::size_t kLists = static_cast<std::size_t>(kWidth<T>);
  static constexpr int kStep = static_cast<int>(Id::size());

  // Traversals that enter one child of a node.
  struct List {
    T near;
    Child child;
    std::int32_t* ids;
    int count;
  };
  using Lists = std::array<List, kLists>;

  // If at most kFew traversals enter a node, they continue one by one, because lists would cost more than
  // they save.
  static constexpr int kFew = 2;
  // Trees of more than kNear bytes do not fit in the cache. Nodes and blocks are then prefetched, and
  // traversals that continue alone are interleaved to hide the latency. Interleaving is faster than lists for
  // up to kFewFar traversals in a node. For Query::closest, it is also faster for up to kMaxDiverging
  // traversals if at most 1/kDivergingShare of the parent's traversals enter the node.
  static constexpr std::size_t kNear = std::size_t{16} << 20;
  static constexpr int kFewFar = 8, kMaxDiverging = 64, kDivergingShare = 4, kInterleaved = 16;

  // Lists are read and written in whole registers, so each list has kPad extra elements.
  static constexpr int room_for(int count) { return (kWidth<T> + 1) * (count + kPad); }
  static constexpr int kReserve = (kDeepestTree + 1) * room_for(1);
  static constexpr int kRoom = kReserve + 2 * room_for(kBatch);

  bool go_alone(int count, int of) const {
    if (!far_) return count <= kFew;
    return count <= kFewFar ||
           (kQuery == Query::closest && count <= kMaxDiverging && count * kDivergingShare <= of);
  }

  // Runs the traversals in `ids` through the subtree `at`. `of` is the number of traversals in the parent
  // node. `room` is the first free element of room_.
  void visit(Child at, const std::int32_t* ids, int count, int of, std::int32_t* room) {
    if (WideTree<T>::is_leaf(at)) {
      meet(at, ids, count);
      return flush();
    }
    if (go_alone(count, of)) return walk(at, ids, count);
    if (room + room_for(count) > room_.data() + (kRoom - kReserve)) {
      const int half = count / 2;
      visit(at, ids, half, of, room);
      return visit(at, ids + half, count - half, of, room);
    }
    Lists lists;
    const std::size_t found = enter(tree_.node(at), ids, count, room, lists);
    if (far_)
      for (std::size_t i = 0; i < found; ++i) tree_.prefetch(lists[i].child);
    for (std::size_t i = 0; i < found; ++i) {
      const List& list = lists[i];
      if (WideTree<T>::is_leaf(list.child)) {
        meet(list.child, list.ids, list.count);
      } else {
        flush();
        visit(list.child, list.ids, list.count, count, room);
      }
    }
    flush();
  }

  // Child that a traversal will visit, and its entry distance.
  struct StackEntry {
    T near;
    Child child;
  };
  // Traversal that continues alone. For Query::closest, the children of each node are on the stack from far
  // to near.
  struct SingleTraversal {
    std::int32_t id;
    Child at;
    std::size_t waiting;
    std::array<StackEntry, (kDeepestTree + 1) * kLists> stack;
  };

  // Runs each traversal through a subtree separately. If the tree is larger than kNear, up to kInterleaved
  // traversals alternate.
  void walk(Child root, const std::int32_t* ids, int count) {
    const auto begin = [&](SingleTraversal& walker, std::int32_t id) {
      walker.id = id;
      walker.at = root;
      walker.waiting = 0;
    };
    if (!far_) {
      for (int i = 0; i < count; ++i) {
        begin(single_traversals_[0], ids[i]);
        while (step<false>(single_traversals_[0])) {
        }
      }
      return;
    }
    int walking = std::min(count, kInterleaved), next = walking;
    std::array<SingleTraversal*, static_cast<std::size_t>(kInterleaved)> in_turn;
    for (std::size_t i = 0; i < static_cast<std::size_t>(walking); ++i)
      begin(*(in_turn[i] = &single_traversals_[i]), ids[i]);
    while (walking > 0) {
      for (int i = 0; i < walking;) {
        SingleTraversal*& walker = in_turn[static_cast<std::size_t>(i)];
        if (step<true>(*walker)) {
          ++i;
        } else if (next < count) {
          begin(*walker, ids[next++]);
          ++i;
        } else {
          std::swap(walker, in_turn[static_cast<std::size_t>(--walking)]);
        }
      }
    }
  }

  // Processes the current node or block and advances to the next. Returns false if the traversal is complete.
  template <bool kFar>
  [[gnu::always_inline]] bool step(SingleTraversal& walker) {
    auto& hit = traversals_.hits[walker.id];
    if (WideTree<T>::is_leaf(walker.at)) {
      const RayBlockPair pair{Blocks<T>::block_of(walker.at), walker.id};
      test(walker.at, std::span(&pair, 1));
    } else {
      open_node(walker, hit.limit());
    }
    do {
      if (walker.waiting == 0) return false;
      --walker.waiting;
    } while (!(walker.stack[walker.waiting].near <= hit.limit() * kFarther<T>));
    walker.at = walker.stack[walker.waiting].child;
    if constexpr (kFar) tree_.prefetch(walker.at);
    return true;
  }

  [[gnu::always_inline]] void open_node(SingleTraversal& walker, T limit) {
    const auto& node = tree_.node(walker.at);
    Lanes<T> near;
    unsigned entered = traversals_.probes[walker.id].enter(node.planes, limit, near);
    ++counts_.node_visits;
    counts_.box_tests += kLists;
    alignas(64) std::array<T, kLists> distance;
    near.copy_to(distance.data(), stdx::vector_aligned);
    const std::size_t first = walker.waiting;
    for (; entered != 0; entered &= entered - 1) {
      const auto child = static_cast<std::size_t>(std::countr_zero(entered));
      std::size_t place = walker.waiting++;
      if constexpr (kQuery == Query::closest)
        for (; place > first && walker.stack[place - 1].near < distance[child]; --place)
          walker.stack[place] = walker.stack[place - 1];
      walker.stack[place] = {distance[child], node.child[child]};
    }
  }

  // Tests the traversals against the children of a node. Makes one list for each child that at least one
  // traversal enters. Stores the list elements at `room` and advances `room`. Returns the number of lists.
  std::size_t enter(const typename WideTree<T>::Node& node, const std::int32_t* ids, int count,
                    std::int32_t*& room, Lists& lists) {
    Lanes<T> nearest(std::numeric_limits<T>::infinity());
    std::int32_t* masks = room;
    unsigned all = 0;
    for (int i = 0; i < count; ++i) {
      Lanes<T> near;
      const unsigned entered =
          traversals_.probes[ids[i]].enter(node.planes, traversals_.hits[ids[i]].limit(), near);
      nearest = min_first(nearest, near);
      all |= entered;
      masks[i] = static_cast<std::int32_t>(entered);
    }
    std::fill(masks + count, masks + count + kPad, 0);
    counts_.node_visits += static_cast<std::uint64_t>(count);
    counts_.box_tests += static_cast<std::uint64_t>(count * kWidth<T>);
    room += count + kPad;
    alignas(64) std::array<T, kLists> distance;
    nearest.copy_to(distance.data(), stdx::vector_aligned);
    std::size_t found = 0;
    for (; all != 0; all &= all - 1) {
      const int c = std::countr_zero(all);
      const auto child = static_cast<std::size_t>(c);
      const List list{distance[child], node.child[child], room, collect(1 << c, ids, masks, count, room)};
      room += list.count;
      std::size_t place = found++;
      if constexpr (kQuery == Query::closest)
        for (; place > 0 && list.near < lists[place - 1].near; --place) lists[place] = lists[place - 1];
      lists[place] = list;
    }
    room += kPad;
    return found;
  }

  // Copies to `to` the ids whose mask contains `bit`. Returns the number of copied ids.
  static int collect(std::int32_t bit, const std::int32_t* ids, const std::int32_t* masks, int count,
                     std::int32_t* to) {
    std::int32_t* end = to;
    for (int i = 0; i < count; i += kStep) {
      const Id mask(masks + i, stdx::element_aligned);
      const unsigned chosen = bits_of((mask & Id(bit)) != 0);
      compress_store(Id(ids + i, stdx::element_aligned), chosen, end);
      end += std::popcount(chosen);
    }
    return static_cast<int>(end - to);
  }

  // Queues tests of the traversals against the block of a leaf. flush() runs the queued tests.
  void meet(Child leaf, const std::int32_t* ids, int count) {
    if (met_ > 0 && Blocks<T>::pack_number(leaf) != Blocks<T>::pack_number(leaf_)) flush();
    leaf_ = leaf;
    for (int i = 0; i < count; ++i) {
      if (met_ == pairs_.size()) flush();
      pairs_[met_++] = {Blocks<T>::block_of(leaf), ids[i]};
    }
  }

  void flush() {
    if (met_ == 0) return;
    test(leaf_, std::span(pairs_).first(met_));
    met_ = 0;
  }

  // Runs the tests of `pairs`, whose blocks are in the same pack as `leaf`.
  void test(Child leaf, std::span<const RayBlockPair> pairs) {
    const auto& pack = tree_.blocks().pack_of(leaf);
    if constexpr (kQuery == Query::closest)
      pack.closest(pairs, traversals_.rays.data(), traversals_.hits.data(), counts_);
    else
      pack.occlude(pairs, traversals_.rays.data(), traversals_.hits.data(), counts_);
  }

  const WideTree<T>& tree_;
  Traversals& traversals_;
  AcceleratorCounts& counts_;
  const bool far_;
  std::array<SingleTraversal, static_cast<std::size_t>(kInterleaved)> single_traversals_;
  Child leaf_ = 0;  // any block of the pack to which the blocks of pairs_ belong
  std::size_t met_ = 0;
  std::array<RayBlockPair, 1024> pairs_;
  alignas(64) std::array<std::int32_t, kRoom> room_;
};

}  // namespace orrery
