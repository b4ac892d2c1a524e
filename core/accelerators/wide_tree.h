#pragma once

#include <algorithm>
#include <array>

#include "core/accelerators/blocks.h"
#include "core/accelerators/box_testers.h"
#include "core/accelerators/box_tree.h"
#include "core/base/prefetch.h"
#include "core/base/task_scope.h"

namespace orrery {

// Bounding volume hierarchy over primitives packed in blocks. A node has up to one child per SIMD lane.
template <class T>
class WideTree {
 public:
  // Index of a node, or kLeaf | BlockName.
  using Child = std::uint32_t;

  static constexpr std::size_t kPlaces = static_cast<std::size_t>(kWidth<T>);

  struct Node {
    BoxPlanes<T> planes;  // lo > hi in unused places, so that no ray enters them
    std::array<Child, kPlaces> child;

    bool has(std::size_t place) const { return planes[0][place] <= planes[1][place]; }
    Bounds<T> box_of(std::size_t place) const {
      return {{planes[0][place], planes[2][place], planes[4][place]},
              {planes[1][place], planes[3][place], planes[5][place]}};
    }
    void set_box(std::size_t place, const Bounds<T>& box) {
      const std::array<T, 6> sides{box.lo.x, box.hi.x, box.lo.y, box.hi.y, box.lo.z, box.hi.z};
      for (std::size_t side = 0; side < 6; ++side) planes[side][place] = sides[side];
    }
    Bounds<T> box() const {
      return {{stdx::hmin(planes[0]), stdx::hmin(planes[2]), stdx::hmin(planes[4])},
              {stdx::hmax(planes[1]), stdx::hmax(planes[3]), stdx::hmax(planes[5])}};
    }
  };

  WideTree(const BoxTree<T>& tree, const PrimitiveList<T>& primitives) {
    if (tree.empty()) return;
    root_ = convert(tree, 0, primitives, 1);
    box_ = tree.nodes[0].box;
    nodes_.shrink_to_fit();
    blocks_.pack();
    double held = 0;
    for (const TreeItem<T>& item : tree.items) held += half_area(item.box);
    measure(held);
    relative_surface_area_as_built_ = relative_surface_area_;
  }

  // Refits the boxes to primitives that have moved. REQUIRES: `moved` has the order of the original list.
  void follow(const PrimitiveList<T>& moved) {
    const auto boxes = blocks_.follow(moved);
    const auto box_now = [&](Child child, const Bounds<T>& before) {
      if (!is_leaf(child)) return nodes_[child].box();
      const auto& of_pack = boxes[Blocks<T>::pack_number(child)];
      return of_pack.empty() ? before : of_pack[Blocks<T>::block_of(child)];
    };
    for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node)  // children come after their parents
      for (std::size_t i = 0; i < kPlaces; ++i)
        if (node->has(i)) node->set_box(i, box_now(node->child[i], node->box_of(i)));
    box_ = box_now(root_, box_);
    double held = 0;
    for (const auto& primitive : moved)
      if (primitive.bounds.bounded()) held += half_area(padded<T>(primitive.bounds));
    measure(held);
  }
  // Returns the relative surface area divided by its value when the tree was built. The relative surface area
  // is the total area of all boxes of the tree, divided by the total area of the primitives' boxes. A growing
  // value means that rays enter more boxes. The divisor is not the area of the root's box, because a tree
  // built while all primitives overlapped would then seem good after they have moved apart.
  double surface_area_growth() const { return relative_surface_area_ / relative_surface_area_as_built_; }

  bool empty() const { return blocks_.empty(); }
  int depth() const { return depth_; }
  std::size_t bytes() const { return nodes_.size() * sizeof(Node) + blocks_.bytes(); }
  Child root() const { return root_; }
  const Node& node(Child child) const { return nodes_[child]; }
  const Blocks<T>& blocks() const { return blocks_; }
  // Prefetches a node or a block.
  void prefetch(Child child) const {
    if (is_leaf(child))
      blocks_.pack_of(child).prefetch(Blocks<T>::block_of(child));
    else
      prefetch_lines(nodes_[child]);
  }
  const Bounds<T>& box() const { return box_; }
  // Returns the length of the longest side of a leaf box, averaged over all leaves.
  T mean_leaf_extent() const { return mean_leaf_extent_; }
  static bool is_leaf(Child child) { return (child & kLeaf) != 0; }

 private:
  static constexpr Child kLeaf = 0x80000000u;
  static constexpr T kInfinite = std::numeric_limits<T>::infinity();

  Child convert(const BoxTree<T>& tree, std::uint32_t at, const PrimitiveList<T>& primitives, int level) {
    checkpoint();
    depth_ = std::max(depth_, level);
    if (tree.nodes[at].leaf) return add_leaf(tree, tree.nodes[at], primitives);
    const Children children = children_of(tree, at);
    Node node;
    for (std::size_t side = 0; side < 6; ++side)
      node.planes[side] = Lanes<T>(side % 2 ? -kInfinite : kInfinite);
    node.child.fill(kLeaf);
    const std::size_t me = nodes_.size();
    nodes_.emplace_back();
    for (std::size_t i = 0; i < children.count; ++i) {
      node.set_box(i, tree.nodes[children.node[i]].box);
      node.child[i] = convert(tree, children.node[i], primitives, level + 1);
    }
    nodes_[me] = node;
    return static_cast<Child>(me);
  }

  // Children of a wide node. children_of() starts with both children of the binary node. It repeatedly
  // replaces the inner node of the largest area with the two children of that node.
  struct Children {
    std::array<std::uint32_t, kPlaces> node;
    std::array<T, kPlaces> area;  // half area of an inner node; -1 for a leaf
    std::size_t count = 0;

    void set(std::size_t place, const BoxTree<T>& tree, std::uint32_t child) {
      node[place] = child;
      area[place] = tree.nodes[child].leaf ? T(-1) : half_area(tree.nodes[child].box);
    }
  };
  static Children children_of(const BoxTree<T>& tree, std::uint32_t at) {
    Children children;
    children.set(children.count++, tree, tree.nodes[at].left);
    children.set(children.count++, tree, tree.nodes[at].right);
    while (children.count < kPlaces) {
      const auto begin = children.area.begin();
      const auto largest = std::max_element(begin, begin + static_cast<std::ptrdiff_t>(children.count));
      if (*largest < 0) break;
      const auto place = static_cast<std::size_t>(largest - begin);
      const auto& opened = tree.nodes[children.node[place]];
      children.set(place, tree, opened.left);
      children.set(children.count++, tree, opened.right);
    }
    return children;
  }

  Child add_leaf(const BoxTree<T>& tree, const typename BoxTree<T>::Node& leaf,
                 const PrimitiveList<T>& primitives) {
    std::array<std::uint32_t, Blocks<T>::kSize> places;
    const std::size_t count = leaf.right - leaf.left;
    for (std::size_t i = 0; i < count; ++i) places[i] = tree.items[leaf.left + i].primitive;
    return kLeaf | blocks_.add(primitives, std::span(places).first(count));
  }

  // Computes relative_surface_area_ and mean_leaf_extent_. `held` is the total half area of the primitives'
  // boxes.
  void measure(double held) {
    checkpoint();
    double area = 0, sides = 0;
    std::size_t leaves = 0;
    const auto add = [&](Child child, const Bounds<T>& box) {
      area += half_area(box);
      if (!is_leaf(child)) return;
      sides += max_component(box.hi - box.lo);
      ++leaves;
    };
    add(root_, box_);
    for (const Node& node : nodes_)
      for (std::size_t i = 0; i < kPlaces; ++i)
        if (node.has(i)) add(node.child[i], node.box_of(i));
    relative_surface_area_ = area / held;
    mean_leaf_extent_ = static_cast<T>(sides / static_cast<double>(leaves));
  }

  Child root_ = 0;
  int depth_ = 0;
  Bounds<T> box_;
  T mean_leaf_extent_ = 0;
  double relative_surface_area_ = 1, relative_surface_area_as_built_ = 1;  // see surface_area_growth()
  std::vector<Node> nodes_;
  Blocks<T> blocks_;
};

}  // namespace orrery
