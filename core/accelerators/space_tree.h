#pragma once

#include <numeric>
#include <optional>
#include <span>

#include "core/accelerators/box_tree.h"
#include "core/accelerators/single_ray.h"
#include "core/base/task_scope.h"

namespace orrery {

// Cell that may be divided, and the items that touch it.
template <class T>
struct SpaceCell {
  Bounds<T> box;
  std::span<const std::uint32_t> items;  // indices of TreeItems, ascending
  int depth;                             // number of planes above the cell
  std::size_t node;
};

struct SpacePlane {
  std::size_t axis;
  double at;
};

// k-d tree over space. A primitive belongs to every cell that its box touches (Bentley 1975; Fussell and
// Subramanian, "Fast Ray Tracing Using K-D Trees", 1988). Splitter chooses the planes:
//   Splitter(const std::vector<TreeItem<T>>& items)
//   std::optional<SpacePlane> split(const SpaceCell<T>&) const;   nullopt: the cell becomes a leaf
//   static constexpr std::size_t kReferences;                     maximum mean references per primitive
// Cells are divided level by level, so that all parts of the scene share the limit on references evenly.
template <class T, class Splitter>
class SpaceTree {
 public:
  explicit SpaceTree(const PrimitiveList<T>& primitives) {
    const std::vector<TreeItem<T>> items = items_of(primitives);
    if (items.empty()) return;
    const Splitter splitter(items);
    for (const auto& item : items) box_.include(item.box);
    nodes_.emplace_back();
    Level level{{{box_, items.size(), 0}}, std::vector<std::uint32_t>(items.size())};
    std::iota(level.items.begin(), level.items.end(), 0u);
    std::size_t left = (Splitter::kReferences - 1) * items.size();  // references that may still be added
    for (; !level.cells.empty(); ++depth_) {
      Level next;
      std::span<const std::uint32_t> rest = level.items;
      for (const LevelCell& open : level.cells) {
        checkpoint();
        const SpaceCell<T> cell{open.box, rest.first(open.items), depth_, open.node};
        rest = rest.subspan(open.items);
        if (const auto plane = splitter.split(cell); plane && divide(cell, *plane, items, left, next))
          continue;
        add_leaf(cell, items, primitives);
      }
      level = std::move(next);
    }
    blocks_.pack();
  }

  bool empty() const { return nodes_.empty(); }
  AcceleratorFacts facts() const {
    return {.bytes = nodes_.size() * sizeof(Node) + names_.size() * sizeof(BlockName) + blocks_.bytes(),
            .depth = depth_,
            .references = blocks_.references()};
  }

  // Visits cells from near to far. Visits both sides of a plane if rounding could decide which side the ray
  // enters.
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
        at = near;  // reached only if a distance is NaN; the choice does not matter
      }
    }
  }

 private:
  static constexpr std::uint32_t kLeaf = 3;
  static constexpr int kDeepest = 80;  // maximum number of planes above a cell
  struct Node {
    T plane;
    std::uint32_t axis, first, count;  // first of two adjacent children; in a leaf: range in names_
  };
  struct Stretch {
    std::uint32_t node;
    T from, to;
  };
  // Cell of one depth: number of its items, and index in nodes_.
  struct LevelCell {
    Bounds<T> box;
    std::size_t items, node;
  };
  // All cells of one depth. `items` contains the items of all cells, cell by cell, which saves allocations.
  struct Level {
    std::vector<LevelCell> cells;
    std::vector<std::uint32_t> items;
  };

  static T latest(const TraversalState<T>& state, const Node& node) {
    return state.probe.latest(node.axis, node.plane) * kFarther<T>;
  }

  // Divides a cell. Returns false and changes nothing if the plane is not inside the cell, the tree would
  // become too deep, or the division would add too many references.
  bool divide(const SpaceCell<T>& cell, const SpacePlane& plane, const std::vector<TreeItem<T>>& items,
              std::size_t& left, Level& next) {
    const T at = static_cast<T>(plane.at);
    if (!(cell.box.lo[plane.axis] < at && at < cell.box.hi[plane.axis]) || cell.depth + 1 >= kDeepest)
      return false;
    const std::size_t first = next.items.size();
    const auto add_items = [&](const auto& reaches) {
      for (const std::uint32_t item : cell.items) {
        checkpoint(item);
        if (reaches(items[item].box)) next.items.push_back(item);
      }
      return next.items.size();
    };
    const std::size_t middle = add_items([&](const Bounds<T>& box) { return box.lo[plane.axis] <= at; });
    const std::size_t last = add_items([&](const Bounds<T>& box) { return box.hi[plane.axis] >= at; });
    const std::size_t added = last - first - cell.items.size();
    if (added > left) {
      next.items.resize(first);
      return false;
    }
    left -= added;
    LevelCell below{cell.box, middle - first, nodes_.size()},
        above{cell.box, last - middle, nodes_.size() + 1};
    below.box.hi[plane.axis] = above.box.lo[plane.axis] = at;
    nodes_[cell.node] = {at, static_cast<std::uint32_t>(plane.axis), static_cast<std::uint32_t>(below.node),
                         0};
    nodes_.resize(nodes_.size() + 2);
    next.cells.push_back(below);
    next.cells.push_back(above);
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
