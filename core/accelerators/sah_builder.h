#pragma once

#include <algorithm>
#include <array>

#include "core/accelerators/box_tree.h"
#include "core/base/parallel.h"

namespace orrery {

// Top down by the surface area heuristic (Goldsmith and Salmon 1987), binned (Wald, "On fast Construction of
// SAH-based Bounding Volume Hierarchies", 2007). The tree depends on the items alone, not on threads.
template <class T>
class SahBuilder {
 public:
  // Relative costs: of visiting a node, and of testing a block of items.
  static constexpr T kNodeCost = T(0.5), kBlockCost = T(1);

  static BoxTree<T> build(std::vector<TreeItem<T>> items) {
    BoxTree<T> tree{.nodes = {}, .items = std::move(items)};
    if (tree.empty()) return tree;
    tree.nodes.resize(2 * tree.items.size() - 1);
    SahBuilder(tree).fill(0, 0, static_cast<std::uint32_t>(tree.items.size()), 0);
    return tree;
  }

 private:
  static constexpr int kBins = 16;
  static constexpr std::uint32_t kParallel = 4096;  // items worth a task of their own
  struct Bin {
    Bounds<T> box;
    std::uint32_t count = 0;
  };
  struct Split {
    T cost = std::numeric_limits<T>::infinity();
    int axis = 0, bin = 0;
  };
  // Maps twice the centre of a box to a bin of one axis.
  struct Scale {
    Vec3<T> from, factor;
    int bin(const Bounds<T>& box, int axis) const {
      const auto at = [axis](const Vec3<T>& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
      const int bin = static_cast<int>((at(box.lo) + at(box.hi) - at(from)) * at(factor));
      return std::clamp(bin, 0, kBins - 1);
    }
  };

  explicit SahBuilder(BoxTree<T>& tree) : tree_(tree) {}

  // Node `at` gets the items from..to-1; its 2(to - from) - 2 descendants take the places after it.
  void fill(std::uint32_t at, std::uint32_t from, std::uint32_t to, int depth) {
    auto& node = tree_.nodes[at];
    Bounds<T> centers;
    bool mixed = false;
    for (std::uint32_t i = from; i < to; ++i) {
      interruption_point(i);
      const TreeItem<T>& item = tree_.items[i];
      node.box.include(item.box);
      centers.include(item.box.lo + item.box.hi);
      mixed = mixed || item.kernel != tree_.items[from].kernel;
    }
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

  // Reorders the items and returns the first of the right child, or `from` for a leaf.
  std::uint32_t choose_middle(const Bounds<T>& box, const Bounds<T>& centers, std::uint32_t from,
                              std::uint32_t to, bool mixed, int depth) {
    const std::uint32_t count = to - from;
    if (count == 1) return from;
    Scale scale;
    const Split split = best_split(box, centers, from, to, scale);
    const bool may_be_leaf = count <= static_cast<std::uint32_t>(kBlock<T>);
    if (may_be_leaf && !(split.cost < cost_of(count))) return mixed ? divide_by_kernel(from, to) : from;
    if (depth >= kDepthGuard || split.cost == std::numeric_limits<T>::infinity()) return from + count / 2;
    return partition(from, to,
                     [&](const TreeItem<T>& item) { return scale.bin(item.box, split.axis) <= split.bin; });
  }

  static T cost_of(std::uint32_t count) {
    return kBlockCost * static_cast<T>((count + kBlock<T> - 1) / kBlock<T>);
  }

  Split best_split(const Bounds<T>& box, const Bounds<T>& centers, std::uint32_t from, std::uint32_t to,
                   Scale& scale) const {
    const Vec3<T> extent = centers.hi - centers.lo;
    const auto factor = [](T e) { return e > 0 ? T(kBins) / e : T(0); };
    scale = {centers.lo, {factor(extent.x), factor(extent.y), factor(extent.z)}};
    std::array<std::array<Bin, kBins>, 3> bins;
    for (std::uint32_t i = from; i < to; ++i) {
      interruption_point(i);
      const Bounds<T>& b = tree_.items[i].box;
      for (int axis = 0; axis < 3; ++axis) {
        Bin& bin = bins[static_cast<std::size_t>(axis)][static_cast<std::size_t>(scale.bin(b, axis))];
        bin.box.include(b);
        ++bin.count;
      }
    }
    Split best;
    const T whole = half_area(box);
    for (int axis = 0; axis < 3; ++axis) sweep(bins[static_cast<std::size_t>(axis)], axis, whole, best);
    return best;
  }

  static void sweep(const std::array<Bin, kBins>& bins, int axis, T whole, Split& best) {
    std::array<T, kBins> right;
    Bin sum;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      sum.box.include(bins[i].box);
      sum.count += bins[i].count;
      right[i] = sum.count > 0 ? half_area(sum.box) * cost_of(sum.count) : T(-1);
    }
    sum = {};
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      sum.box.include(bins[i].box);
      sum.count += bins[i].count;
      if (sum.count == 0 || right[i + 1] < 0) continue;
      const T parts = half_area(sum.box) * cost_of(sum.count) + right[i + 1];
      const T cost = kNodeCost + (whole > 0 ? parts / whole : T(0));
      if (cost < best.cost) best = {cost, axis, static_cast<int>(i)};
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
