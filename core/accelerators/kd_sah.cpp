#include <array>

#include "core/accelerators/space_tree.h"

namespace orrery {
namespace {

// Splits a cell at the plane of the lowest cost by the surface area heuristic (MacDonald and Booth,
// "Heuristics for ray tracing using space subdivision", 1990), among 31 candidates per axis (Hurley et al.,
// "Fast Ray Tracing for Modern General Purpose CPU", 2002).
template <class T>
class SurfaceSplitter {
 public:
  static constexpr std::size_t kReferences = 3;

  explicit SurfaceSplitter(const std::vector<TreeItem<T>>& items) : items_(items) {}

  std::optional<SpacePlane> split(const SpaceCell<T>& cell) const {
    const double whole = half_area(cell.box);
    if (cell.items.size() <= 1 || !(whole > 0)) return {};
    double least = cost_of(cell.items.size());
    std::optional<SpacePlane> best;
    for (std::size_t axis = 0; axis < 3; ++axis) sweep(cell, axis, whole, least, best);
    return best;
  }

 private:
  static constexpr std::size_t kBins = 32;
  // Relative costs of visiting a node and of testing a block. The cost of a plane that cuts off empty space
  // is multiplied by kEmptyShare.
  static constexpr double kVisitCost = 0.6, kBlockCost = 1, kEmptyShare = 0.8;

  static double cost_of(std::size_t items) {
    return kBlockCost * static_cast<double>((items + Blocks<T>::kSize - 1) / Blocks<T>::kSize);
  }

  void sweep(const SpaceCell<T>& cell, std::size_t axis, double whole, double& least,
             std::optional<SpacePlane>& best) const {
    const double lo = cell.box.lo[axis], hi = cell.box.hi[axis], step = (hi - lo) / kBins;
    if (!(step > 0)) return;
    std::array<std::size_t, kBins> starts{}, ends{};
    const auto bin = [&](double at) {
      return static_cast<std::size_t>(std::clamp((at - lo) / step, 0.0, double(kBins - 1)));
    };
    for (const std::uint32_t item : cell.items) {
      checkpoint(item);
      ++starts[bin(items_[item].box.lo[axis])];
      ++ends[bin(items_[item].box.hi[axis])];
    }
    std::size_t below = 0, above = cell.items.size();
    for (std::size_t k = 1; k < kBins; ++k) {
      below += starts[k - 1];
      above -= ends[k - 1];
      const double at = lo + step * static_cast<double>(k);
      Bounds<T> left = cell.box, right = cell.box;
      left.hi[axis] = right.lo[axis] = static_cast<T>(at);
      const double parts = half_area(left) * cost_of(below) + half_area(right) * cost_of(above);
      const double cost = (kVisitCost + parts / whole) * (below == 0 || above == 0 ? kEmptyShare : 1.0);
      if (cost < least) least = cost, best = SpacePlane{axis, at};
    }
  }

  const std::vector<TreeItem<T>>& items_;
};

template <class T>
using KdSah = SingleRayAccelerator<T, SpaceTree<T, SurfaceSplitter<T>>>;

}  // namespace

AcceleratorType kd_sah_type() {
  return {"kd-sah",
          "k-d tree split by the surface area heuristic.",
          {.ray = 46, .visit = 4.2, .box = 0, .primitive = 1.0},
          build_accelerator<KdSah, float>,
          build_accelerator<KdSah, double>};
}

}  // namespace orrery
