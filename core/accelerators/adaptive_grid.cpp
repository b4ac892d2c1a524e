#include "core/accelerators/grid_tree.h"

namespace orrery {
namespace {

// Grid whose resolution follows the local density: crowded cells contain nested grids (Jevans and Wyvill,
// "Adaptive Voxel Subdivision for Ray Tracing", 1989).
constexpr GridOptions kNested{.cells = 0.25, .references = 12, .most = 12, .levels = 8};

template <class T>
using AdaptiveGrid = SingleRayAccelerator<T, GridTree<T, kNested>>;

}  // namespace

AcceleratorType adaptive_grid_type() {
  return {"adaptive-grid",
          "Uniform grid with nested grids in crowded cells.",
          {.ray = 38, .visit = 28, .box = 0, .primitive = 1.3},
          build_accelerator<AdaptiveGrid, float>,
          build_accelerator<AdaptiveGrid, double>};
}

}  // namespace orrery
