#include "core/accelerators/space_tree.h"

namespace orrery {
namespace {

// Splits a cell across its longest side, at the median of its items' centres. A cell becomes a leaf if its
// items fit in one block.
template <class T>
class MedianSplitter {
 public:
  static constexpr std::size_t kReferences = 3;

  explicit MedianSplitter(const std::vector<TreeItem<T>>& items) : items_(items) {}

  std::optional<SpacePlane> split(const SpaceCell<T>& cell) const {
    if (cell.items.size() <= Blocks<T>::kSize) return {};
    const Vec3<T> size = cell.box.hi - cell.box.lo;
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::vector<double> centers;
    for (const std::uint32_t item : cell.items) {
      checkpoint(item);
      const Bounds<T>& box = items_[item].box;
      centers.push_back((double{box.lo[axis]} + double{box.hi[axis]}) / 2);
    }
    const auto middle = centers.begin() + static_cast<std::ptrdiff_t>(centers.size() / 2);
    std::nth_element(centers.begin(), middle, centers.end());
    if (cut(cell, axis, *middle) * 4 > cell.items.size() * 3) return {};  // over 3/4 would be on both sides
    return SpacePlane{axis, *middle};
  }

 private:
  std::size_t cut(const SpaceCell<T>& cell, std::size_t axis, double at) const {
    std::size_t count = 0;
    for (const std::uint32_t item : cell.items) {
      checkpoint(item);
      const Bounds<T>& box = items_[item].box;
      count += box.lo[axis] <= static_cast<T>(at) && box.hi[axis] >= static_cast<T>(at);
    }
    return count;
  }

  const std::vector<TreeItem<T>>& items_;
};

template <class T>
using KdMedian = SingleRayAccelerator<T, SpaceTree<T, MedianSplitter<T>>>;

}  // namespace

AcceleratorType kd_median_type() {
  return {"kd-median",
          "k-d tree split at the median.",
          {.ray = 31, .visit = 6.2, .box = 0, .primitive = 1.0},
          build_accelerator<KdMedian, float>,
          build_accelerator<KdMedian, double>};
}

}  // namespace orrery
