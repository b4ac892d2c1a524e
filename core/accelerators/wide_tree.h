#pragma once

#include <algorithm>
#include <array>

#include "core/accelerators/blocks.h"
#include "core/accelerators/box_tree.h"
#include "core/accelerators/probes.h"

namespace orrery {

// A tree of boxes whose nodes have as many children as a register has lanes, over primitives packed in
// blocks.
template <class T>
class WideTree {
 public:
  // The place of a node, or kLeaf and the name of a block.
  using Child = std::uint32_t;

  struct Node {
    BoxPlanes<T> planes;  // of places without a child: inside out, so that nothing enters
    std::array<Child, static_cast<std::size_t>(kWidth<T>)> child;
  };

  WideTree(const BoxTree<T>& tree, const PrimitiveList<T>& primitives) {
    if (tree.empty()) return;
    root_ = convert(tree, 0, primitives, 1);
    box_ = tree.nodes[0].box;
    grain_ /= static_cast<T>(leaves_);
    nodes_.shrink_to_fit();
    blocks_.pack();
  }

  bool empty() const { return blocks_.empty(); }
  int depth() const { return depth_; }
  std::size_t bytes() const { return nodes_.size() * sizeof(Node) + blocks_.bytes(); }
  Child root() const { return root_; }
  const Node& node(Child child) const { return nodes_[child]; }
  const Blocks<T>& blocks() const { return blocks_; }
  const Bounds<T>& box() const { return box_; }
  // Mean of the longest side of a leaf's box.
  T grain() const { return grain_; }
  static bool is_leaf(Child child) { return (child & kLeaf) != 0; }

 private:
  static constexpr Child kLeaf = 0x80000000u;
  static constexpr T kInfinite = std::numeric_limits<T>::infinity();

  Child convert(const BoxTree<T>& tree, std::uint32_t at, const PrimitiveList<T>& primitives, int level) {
    depth_ = std::max(depth_, level);
    if (tree.nodes[at].leaf) return add_leaf(tree, tree.nodes[at], primitives);
    const std::vector<std::uint32_t> children = children_of(tree, at);
    Node node;
    for (std::size_t side = 0; side < 6; ++side)
      node.planes[side] = Lanes<T>(side % 2 ? -kInfinite : kInfinite);
    node.child.fill(kLeaf);
    const std::size_t me = nodes_.size();
    nodes_.emplace_back();
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Bounds<T>& box = tree.nodes[children[i]].box;
      const std::array<T, 6> sides{box.lo.x, box.hi.x, box.lo.y, box.hi.y, box.lo.z, box.hi.z};
      for (std::size_t side = 0; side < 6; ++side) node.planes[side][i] = sides[side];
      node.child[i] = convert(tree, children[i], primitives, level + 1);
    }
    nodes_[me] = node;
    return static_cast<Child>(me);
  }

  // The largest descendants that make a full node.
  static std::vector<std::uint32_t> children_of(const BoxTree<T>& tree, std::uint32_t at) {
    std::vector<std::uint32_t> children{tree.nodes[at].left, tree.nodes[at].right};
    while (children.size() < static_cast<std::size_t>(kWidth<T>)) {
      const auto size = [&](std::uint32_t n) {
        return tree.nodes[n].leaf ? T(-1) : half_area(tree.nodes[n].box);
      };
      const auto largest = std::max_element(children.begin(), children.end(),
                                            [&](auto a, auto b) { return size(a) < size(b); });
      if (size(*largest) < 0) break;
      const auto& opened = tree.nodes[*largest];
      *largest = opened.left;
      children.push_back(opened.right);
    }
    return children;
  }

  Child add_leaf(const BoxTree<T>& tree, const typename BoxTree<T>::Node& leaf,
                 const PrimitiveList<T>& primitives) {
    grain_ += max_component(leaf.box.hi - leaf.box.lo);
    ++leaves_;
    std::array<std::uint32_t, Blocks<T>::kSize> places;
    const std::size_t count = leaf.right - leaf.left;
    for (std::size_t i = 0; i < count; ++i) places[i] = tree.items[leaf.left + i].primitive;
    return kLeaf | blocks_.add(primitives, std::span(places).first(count));
  }

  Child root_ = 0;
  int depth_ = 0;
  Bounds<T> box_;
  T grain_ = 0;
  std::size_t leaves_ = 0;
  std::vector<Node> nodes_;
  Blocks<T> blocks_;
};

}  // namespace orrery
