#pragma once

#include <deque>
#include <optional>

#include "core/accelerators/box_tree.h"
#include "core/accelerators/single_ray.h"
#include "core/base/work_scope.h"

namespace orrery {

// A cell of space that is to be divided, and what reaches into it.
template <class T>
struct SpaceCell {
  Bounds<T> box;
  std::vector<std::uint32_t> items;  // places in the list of TreeItems, ascending
  int depth;                         // planes that were drawn to make it
  std::size_t node;
};

struct SpacePlane {
  std::size_t axis;
  double at;
};

// Space divided by planes, again and again; a primitive belongs to every cell that its box reaches into
// (Bentley 1975; Fussell and Subramanian, "Fast Ray Tracing Using K-D Trees", 1988). Splitter says where:
//   Splitter(const std::vector<TreeItem<T>>& items)
//   std::optional<SpacePlane> split(const SpaceCell<T>&) const;   none: the cell becomes a leaf
//   static constexpr std::size_t kReferences;                     a primitive, on average, at most
// Cells are divided level by level, so that the last references are shared fairly.
template <class T, class Splitter>
class SpaceTree {
 public:
  explicit SpaceTree(const PrimitiveList<T>& primitives) {
    const std::vector<TreeItem<T>> items = items_of(primitives);
    if (items.empty()) return;
    const Splitter splitter(items);
    SpaceCell<T> all{{}, {}, 0, 0};
    for (std::uint32_t i = 0; i < items.size(); ++i) all.items.push_back(i);
    for (const auto& item : items) all.box.include(item.box);
    box_ = all.box;
    nodes_.emplace_back();
    std::size_t left = (Splitter::kReferences - 1) * items.size();  // references that may still be added
    std::deque<SpaceCell<T>> open{std::move(all)};
    for (; !open.empty(); open.pop_front()) {
      interruption_point();
      SpaceCell<T>& cell = open.front();
      depth_ = std::max(depth_, cell.depth + 1);
      if (const auto plane = splitter.split(cell); plane && divide(cell, *plane, items, left, open)) continue;
      add_leaf(cell, items, primitives);
    }
    blocks_.pack();
  }

  bool empty() const { return nodes_.empty(); }
  AcceleratorFacts facts() const {
    return {.bytes = nodes_.size() * sizeof(Node) + names_.size() * sizeof(BlockName) + blocks_.bytes(),
            .depth = depth_,
            .references = blocks_.references()};
  }

  // Cells from near to far. Where a ray crosses a plane so close to the end of a stretch that rounding may
  // decide, both sides are walked.
  template <Query kQuery>
  void traverse(TraversalState<T>& state) const {
    Stretch at{0, 0, state.hit.t};
    if (!state.probe.clip(box_, at.from, at.to)) return;
    std::array<Stretch, kDeepest> later;
    std::size_t waiting = 0;
    for (;;) {
      ++state.counts.node_visits;
      const Node& node = nodes_[at.node];
      if (node.axis == kLeaf) {
        state.template meet<kQuery>(blocks_, std::span(names_).subspan(node.first, node.count));
        do {
          if (waiting == 0) return;
          at = later[--waiting];
        } while (!state.open(at.from));
        continue;
      }
      const bool down = state.probe.descending(node.axis);
      const Stretch near{node.first + down, at.from, min_first(at.to, latest(state, node))};
      const Stretch far{node.first + !down, max_first(at.from, state.probe.earliest(node.axis, node.plane)),
                        at.to};
      const bool enters_far = far.from <= far.to * kFarther<T>;
      if (near.from <= near.to) {
        if (enters_far) later[waiting++] = far;
        at = near;
      } else if (enters_far) {
        at = far;
      } else {
        at = near;  // only numbers that are none come here: any cell will do
      }
    }
  }

 private:
  static constexpr std::uint32_t kLeaf = 3;
  static constexpr int kDeepest = 80;  // planes between the whole and a cell, at most
  struct Node {
    T plane;
    std::uint32_t axis, first, count;  // first child, the other follows; of a leaf: its block names
  };
  struct Stretch {
    std::uint32_t node;
    T from, to;
  };

  static T latest(const TraversalState<T>& state, const Node& node) {
    return state.probe.latest(node.axis, node.plane) * kFarther<T>;
  }

  // False, and nothing is changed, if that would help no ray or cost too many references.
  bool divide(SpaceCell<T>& cell, const SpacePlane& plane, const std::vector<TreeItem<T>>& items,
              std::size_t& left, std::deque<SpaceCell<T>>& open) {
    const T at = static_cast<T>(plane.at);
    T& lo = cell.box.lo[plane.axis];
    T& hi = cell.box.hi[plane.axis];
    if (!(lo < at && at < hi) || cell.depth + 1 >= kDeepest) return false;
    SpaceCell<T> below{cell.box, {}, cell.depth + 1, nodes_.size()};
    SpaceCell<T> above{cell.box, {}, cell.depth + 1, nodes_.size() + 1};
    below.box.hi[plane.axis] = at;
    above.box.lo[plane.axis] = at;
    for (const std::uint32_t item : cell.items) {
      interruption_point(item);
      if (items[item].box.lo[plane.axis] <= at) below.items.push_back(item);
      if (items[item].box.hi[plane.axis] >= at) above.items.push_back(item);
    }
    const std::size_t added = below.items.size() + above.items.size() - cell.items.size();
    if (added > left) return false;
    left -= added;
    nodes_[cell.node] = {at, static_cast<std::uint32_t>(plane.axis), static_cast<std::uint32_t>(below.node),
                         0};
    nodes_.resize(nodes_.size() + 2);
    open.push_back(std::move(below));
    open.push_back(std::move(above));
    return true;
  }

  void add_leaf(const SpaceCell<T>& cell, const std::vector<TreeItem<T>>& items,
                const PrimitiveList<T>& primitives) {
    std::vector<std::uint32_t> places;
    for (const std::uint32_t item : cell.items) places.push_back(items[item].primitive);
    const std::size_t first = names_.size();
    blocks_.add_all(primitives, places, names_);
    nodes_[cell.node] = {T(0), kLeaf, static_cast<std::uint32_t>(first),
                         static_cast<std::uint32_t>(names_.size() - first)};
  }

  Bounds<T> box_;
  std::vector<Node> nodes_;
  std::vector<BlockName> names_;
  Blocks<T> blocks_;
  int depth_ = 0;
};

}  // namespace orrery
