#pragma once

#include <numeric>
#include <span>

#include "core/accelerators/box_tree.h"
#include "core/accelerators/grid_layout.h"
#include "core/accelerators/single_ray.h"
#include "core/base/task_scope.h"

namespace orrery {

struct GridOptions {
  double cells;            // approximate number of cells per primitive
  std::size_t references;  // maximum mean number of references per primitive
  std::size_t most;        // items per cell above which a nested grid is tried
  int levels;              // maximum nesting depth of grids
};

// Grid of nearly cubic cells. A primitive belongs to every cell that its box touches. A crowded cell may
// contain a nested grid around its items.
template <class T, const GridOptions& kOptions>
class GridTree {
 public:
  explicit GridTree(const PrimitiveList<T>& primitives) {
    const std::vector<TreeItem<T>> items = items_of(primitives);
    if (items.empty()) return;
    std::size_t left = (kOptions.references - 1) * items.size();  // references that may still be added
    Bounds<T> all;
    for (const auto& item : items) all.include(item.box);
    cells_.emplace_back();
    Level level{{{all, items.size(), 0}}, std::vector<std::uint32_t>(items.size())};
    std::iota(level.items.begin(), level.items.end(), 0u);
    for (int depth = 0; !level.cells.empty(); ++depth) {
      Level next;
      std::span<const std::uint32_t> rest = level.items;
      for (const LevelCell& open : level.cells) {
        checkpoint();
        const PendingCell cell{open.box, rest.first(open.items), depth, open.cell};
        rest = rest.subspan(open.items);
        if (!divide(cell, items, left, next)) add_cell(cell, items, primitives);
      }
      level = std::move(next);
    }
    blocks_.pack();
  }

  bool empty() const { return cells_.empty(); }
  AcceleratorFacts facts() const {
    return {.bytes = grids_.size() * sizeof(Grid) + cells_.size() * sizeof(Cell) +
                     names_.size() * sizeof(BlockName) + blocks_.bytes(),
            .depth = depth_,
            .references = blocks_.references()};
  }

  template <Query kQuery>
  void traverse(TraversalState<T>& state) const {
    enter<kQuery>(state, cells_.front(), T(0), state.hit.t);
  }

 private:
  struct Grid {
    GridLayout<T> layout;
    std::size_t first;  // index in cells_ of the first cell
  };
  static constexpr std::uint32_t kGrid = ~0u;
  struct Cell {
    std::uint32_t first = 0, count = 0;  // range in names_; for a nested grid: its index in grids_, and kGrid
  };
  // Cell that may become a grid.
  struct PendingCell {
    Bounds<T> box;
    std::span<const std::uint32_t> items;  // indices of TreeItems, ascending
    int level;
    std::size_t cell;
  };
  // Cell of one level: number of its items, and index in cells_.
  struct LevelCell {
    Bounds<T> box;
    std::size_t items, cell;
  };
  // All cells of one level. `items` contains the items of all cells, cell by cell, which saves allocations.
  struct Level {
    std::vector<LevelCell> cells;
    std::vector<std::uint32_t> items;
  };

  // Returns the box around the parts of the items that are inside the cell.
  static Bounds<T> around(const PendingCell& cell, const std::vector<TreeItem<T>>& items) {
    Bounds<T> box;
    for (const std::uint32_t item : cell.items) {
      checkpoint(item);
      Bounds<T> part = items[item].box;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        part.lo[axis] = std::max(part.lo[axis], cell.box.lo[axis]);
        part.hi[axis] = std::min(part.hi[axis], cell.box.hi[axis]);
      }
      box.include(part);
    }
    return box;
  }

  // Replaces the cell with a grid. Reduces the number of grid cells while the grid would add more than `left`
  // references, or more than four per item to a nested grid. Returns false if no grid of at least two cells
  // is acceptable, or if the cell needs no grid.
  bool divide(const PendingCell& cell, const std::vector<TreeItem<T>>& items, std::size_t& left,
              Level& next) {
    const std::size_t count = cell.items.size();
    if (cell.level >= kOptions.levels || (cell.level > 0 && count <= kOptions.most)) return false;
    const Bounds<T> box = around(cell, items);
    for (double cells = kOptions.cells * static_cast<double>(count); cells >= 2; cells /= 8) {
      const GridLayout<T> layout(box, cells);
      std::size_t made = 0;
      for (const std::uint32_t item : cell.items) {
        checkpoint();
        layout.for_each_touching(items[item].box, [&](const CellIndex&) { ++made; });
      }
      const bool shared = cell.level > 0 && made > 4 * count;
      if (made > left + count || shared) continue;
      left = left + count - made;
      depth_ = std::max(depth_, cell.level + 1);
      add_grid(layout, cell, items, next);
      return true;
    }
    return false;
  }

  void add_grid(const GridLayout<T>& layout, const PendingCell& cell, const std::vector<TreeItem<T>>& items,
                Level& next) {
    const std::size_t first = cells_.size();
    cells_[cell.cell] = {static_cast<std::uint32_t>(grids_.size()), kGrid};
    cells_.resize(first + layout.cells());
    grids_.push_back({layout, first});
    const auto for_each_item_in_cell = [&](const auto& visit) {
      for (const std::uint32_t item : cell.items) {
        checkpoint();
        layout.for_each_touching(items[item].box, [&](const CellIndex& i) { visit(layout.number(i), item); });
      }
    };
    std::vector<std::size_t> places(layout.cells());  // items per cell, then next free index in next.items
    for_each_item_in_cell([&](std::size_t i, std::uint32_t) { ++places[i]; });
    std::size_t end = next.items.size();
    layout.for_each_touching(layout.box(), [&](const CellIndex& i) {
      std::size_t& place = places[layout.number(i)];
      const std::size_t count = std::exchange(place, end);
      end += count;
      if (count > 0) next.cells.push_back({layout.cell(i), count, first + layout.number(i)});
    });
    next.items.resize(end);
    for_each_item_in_cell([&](std::size_t i, std::uint32_t item) { next.items[places[i]++] = item; });
  }

  void add_cell(const PendingCell& cell, const std::vector<TreeItem<T>>& items,
                const PrimitiveList<T>& primitives) {
    std::vector<std::uint32_t> places;
    for (const std::uint32_t item : cell.items) places.push_back(items[item].primitive);
    const std::size_t first = names_.size();
    blocks_.add_all(primitives, places, names_);
    cells_[cell.cell] = {static_cast<std::uint32_t>(first),
                         static_cast<std::uint32_t>(names_.size() - first)};
  }

  template <Query kQuery>
  void enter(TraversalState<T>& state, const Cell& cell, T from, T to) const {
    if (cell.count != kGrid)
      return state.template meet<kQuery>(blocks_, std::span(names_).subspan(cell.first, cell.count));
    const Grid& grid = grids_[cell.first];
    grid.layout.for_each_along(
        state.ray, state.probe, from, to, [&](T near) { return state.open(near); },
        [&](const CellIndex& i, T near, T far) {
          ++state.counts.node_visits;
          enter<kQuery>(state, cells_[grid.first + grid.layout.number(i)], near, far);
        });
  }

  std::vector<Grid> grids_;
  std::vector<Cell> cells_;  // cells_[0] is the root
  std::vector<BlockName> names_;
  Blocks<T> blocks_;
  int depth_ = 0;
};

}  // namespace orrery
