#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/accelerators/box_tree.h"
#include "core/base/parallel.h"
#include "core/math/lanes.h"

namespace orrery {

// Box as two registers: its low and its high sides on x, y and z. The fourth lane is undefined.
template <class T>
struct BoxLanes {
  using Sides = stdx::simd<T, stdx::simd_abi::deduce_t<T, 4>>;
  Sides lo{std::numeric_limits<T>::infinity()}, hi{-std::numeric_limits<T>::infinity()};

  // Loads four numbers at a time. The second load includes the member that follows the box in TreeItem.
  static BoxLanes of(const TreeItem<T>& item) {
    static_assert(offsetof(TreeItem<T>, box) == 0 && sizeof item >= 7 * sizeof(T));
    const T* sides = reinterpret_cast<const T*>(&item);
    return {Sides(sides, stdx::element_aligned), Sides(sides + 3, stdx::element_aligned)};
  }
  void include(const BoxLanes& b) {
    lo = min_first(lo, b.lo);
    hi = max_first(hi, b.hi);
  }
  void include(const Sides& p) { include({p, p}); }
  Bounds<T> bounds() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

// Top-down builder with the surface area heuristic (Goldsmith and Salmon 1987), binned (Wald, "On fast
// Construction of SAH-based Bounding Volume Hierarchies", 2007). The tree depends on the items only, not on
// the number of threads.
template <class T>
class SahBuilder {
 public:
  // Relative costs of visiting a node and of testing a block of items.
  static constexpr T kNodeCost = T(0.5), kBlockCost = T(1);

  static BoxTree<T> build(std::vector<TreeItem<T>> items) {
    BoxTree<T> tree{.nodes = {}, .items = std::move(items)};
    if (tree.empty()) return tree;
    tree.nodes.resize(2 * tree.items.size() - 1);
    SahBuilder(tree).fill(0, 0, static_cast<std::uint32_t>(tree.items.size()), 0);
    return tree;
  }

 private:
  static constexpr std::size_t kBins = 16, kBinsOfFew = 8;
  static constexpr std::uint32_t kFew = 16;         // nodes of up to kFew items use kBinsOfFew bins
  static constexpr std::uint32_t kParallel = 4096;  // children of smaller nodes are built serially
  using Sides = typename BoxLanes<T>::Sides;
  struct Bin {
    BoxLanes<T> box;
    std::uint32_t count = 0;
  };
  using Bins = std::array<std::array<Bin, 3>, kBins>;  // [bin][axis]
  struct Split {
    T parts = std::numeric_limits<T>::infinity();  // sum over children: half area * cost_of(items)
    std::size_t axis = 0, bin = 0;
  };
  // Maps the centre of a box to a position along each axis, in units of bins. Bin i contains the positions in
  // [i, i + 1). Positions outside all bins belong to the first or the last bin.
  struct Scale {
    Sides from, factor;
    Sides places(const BoxLanes<T>& box) const { return (box.lo + box.hi - from) * factor; }
  };

  explicit SahBuilder(BoxTree<T>& tree) : tree_(tree) {}

  // Builds node `at` from items [from, to). The descendants use the next 2 (to - from) - 2 elements of
  // tree_.nodes.
  void fill(std::uint32_t at, std::uint32_t from, std::uint32_t to, int depth) {
    auto& node = tree_.nodes[at];
    BoxLanes<T> box, centers;
    bool mixed = false;
    for (std::uint32_t i = from; i < to; ++i) {
      checkpoint(i);
      const TreeItem<T>& item = tree_.items[i];
      const auto lanes = BoxLanes<T>::of(item);
      box.include(lanes);
      centers.include(lanes.lo + lanes.hi);
      mixed = mixed || item.kernel != tree_.items[from].kernel;
    }
    node.box = box.bounds();
    const std::uint32_t middle = choose_middle(node.box, centers, from, to, mixed, depth);
    if (middle == from) {
      node.leaf = true;
      node.left = from;
      node.right = to;
      return;
    }
    node.left = at + 1;
    node.right = at + 2 * (middle - from);
    const auto left = [&] { fill(node.left, from, middle, depth + 1); };
    const auto right = [&] { fill(node.right, middle, to, depth + 1); };
    if (to - from >= kParallel) {
      both_in_parallel(left, right);
    } else {
      left();
      right();
    }
  }

  // Splits items [from, to) and reorders them accordingly. Returns the first item of the right child, or
  // `from` if the node becomes a leaf.
  std::uint32_t choose_middle(const Bounds<T>& box, const BoxLanes<T>& centers, std::uint32_t from,
                              std::uint32_t to, bool mixed, int depth) {
    const std::uint32_t count = to - from;
    if (count == 1) return from;
    Scale scale;
    const Split split = best_split(centers, from, to, scale);
    const bool may_be_leaf = count <= static_cast<std::uint32_t>(kBlock<T>);
    const bool may_split = split.parts < std::numeric_limits<T>::infinity();
    if (may_be_leaf && !(may_split && kNodeCost + split.parts / half_area(box) < cost_of(count)))
      return mixed ? divide_by_kernel(from, to) : from;
    if (depth >= kDepthGuard || !may_split) return from + count / 2;
    const T end = static_cast<T>(split.bin + 1);
    return partition(from, to, [&](const TreeItem<T>& item) {
      return !(scale.places(BoxLanes<T>::of(item))[split.axis] >= end);
    });
  }

  static T cost_of(std::uint32_t count) {
    return kBlockCost * static_cast<T>((count + kBlock<T> - 1) / kBlock<T>);
  }

  Split best_split(const BoxLanes<T>& centers, std::uint32_t from, std::uint32_t to, Scale& scale) const {
    const std::size_t used = to - from > kFew ? kBins : kBinsOfFew;
    const Sides extent = centers.hi - centers.lo, zero(T(0));
    scale = {centers.lo, select(extent > zero, Sides(T(used)) / extent, zero)};
    Bins bins;
    std::fill_n(bins.begin(), used, std::array<Bin, 3>{});
    for (std::uint32_t i = from; i < to; ++i) {
      checkpoint(i);
      const auto lanes = BoxLanes<T>::of(tree_.items[i]);
      const Sides places = min_first(max_first(zero, scale.places(lanes)), Sides(T(used - 1)));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Bin& bin = bins[static_cast<std::size_t>(static_cast<int>(places[axis]))][axis];
        bin.box.include(lanes);
        ++bin.count;
      }
    }
    Split best;
    for (std::size_t axis = 0; axis < 3; ++axis) sweep(bins, used, axis, best);
    return best;
  }

  static void sweep(const Bins& bins, std::size_t used, std::size_t axis, Split& best) {
    std::array<T, kBins> right;
    Bin sum;
    for (std::size_t i = used - 1; i > 0; --i) {
      const Bin& bin = bins[i][axis];
      sum.box.include(bin.box);
      sum.count += bin.count;
      right[i] = sum.count > 0 ? half_area(sum.box.bounds()) * cost_of(sum.count) : T(-1);
    }
    sum = {};
    for (std::size_t i = 0; i + 1 < used; ++i) {
      const Bin& bin = bins[i][axis];
      sum.box.include(bin.box);
      sum.count += bin.count;
      if (sum.count == 0 || right[i + 1] < 0) continue;
      const T parts = half_area(sum.box.bounds()) * cost_of(sum.count) + right[i + 1];
      if (parts < best.parts) best = {parts, axis, i};
    }
  }

  std::uint32_t divide_by_kernel(std::uint32_t from, std::uint32_t to) {
    const std::uint32_t kernel = tree_.items[from].kernel;
    return partition(from, to, [kernel](const TreeItem<T>& item) { return item.kernel == kernel; });
  }

  template <class Left>
  std::uint32_t partition(std::uint32_t from, std::uint32_t to, const Left& left) {
    const auto begin = tree_.items.begin();
    return static_cast<std::uint32_t>(std::partition(begin + from, begin + to, left) - begin);
  }

  BoxTree<T>& tree_;
};

}  // namespace orrery
