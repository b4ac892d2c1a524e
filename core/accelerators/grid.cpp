#include "core/accelerators/grid_tree.h"

namespace orrery {
namespace {

// Uniform grid (Fujimoto et al., "ARTS: Accelerated Ray-Tracing System", 1986).
constexpr GridOptions kUniform{.cells = 2, .references = 16, .most = 0, .levels = 1};

template <class T>
using UniformGrid = SingleRayAccelerator<T, GridTree<T, kUniform>>;

}  // namespace

AcceleratorType grid_type() {
  return {"grid",
          "Uniform grid.",
          {.ray = 61, .visit = 19, .box = 0, .primitive = 1.25},
          build_accelerator<UniformGrid, float>,
          build_accelerator<UniformGrid, double>};
}

}  // namespace orrery
