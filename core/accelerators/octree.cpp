#include "core/accelerators/space_tree.h"

namespace orrery {
namespace {

// Splits a cell at its middle into eight equal cells (Glassner, "Space Subdivision for Fast Ray Tracing",
// 1984). The tree stores them as three levels of planes, one level per axis.
template <class T>
class OctantSplitter {
 public:
  static constexpr std::size_t kReferences = 8;

  explicit OctantSplitter(const std::vector<TreeItem<T>>& items) : items_(items) {}

  std::optional<SpacePlane> split(const SpaceCell<T>& cell) const {
    const auto axis = static_cast<std::size_t>(cell.depth % 3);
    if (axis == 0 && !pays(cell)) return {};
    const auto lo = double{cell.box.lo[axis]}, hi = double{cell.box.hi[axis]};
    return SpacePlane{axis, (lo + hi) / 2};
  }

 private:
  static constexpr int kDeepest = 3 * 24;

  // Returns false if the items fit in one block, if the cell is at the maximum depth, or if items would touch
  // three or more octants on average.
  bool pays(const SpaceCell<T>& cell) const {
    if (cell.items.size() <= Blocks<T>::kSize || cell.depth >= kDeepest) return false;
    const Vec3<T> middle = (cell.box.lo + cell.box.hi) * T(0.5);
    std::size_t copies = 0;
    for (const std::uint32_t item : cell.items) {
      checkpoint(item);
      const Bounds<T>& box = items_[item].box;
      std::size_t octants = 1;
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (box.lo[axis] <= middle[axis] && box.hi[axis] >= middle[axis]) octants *= 2;
      copies += octants;
    }
    return copies < 3 * cell.items.size();
  }

  const std::vector<TreeItem<T>>& items_;
};

template <class T>
using Octree = SingleRayAccelerator<T, SpaceTree<T, OctantSplitter<T>>>;

}  // namespace

AcceleratorType octree_type() {
  return {"octree",
          "Octree.",
          {.ray = 28, .visit = 5.6, .box = 0, .primitive = 1.0},
          build_accelerator<Octree, float>,
          build_accelerator<Octree, double>};
}

}  // namespace orrery
