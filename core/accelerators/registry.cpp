#include "core/accelerators/registry.h"

#include <array>

namespace orrery {

// One line per accelerator, implemented in the file of the same name.
// clang-format off
#define ORRERY_ACCELERATORS(add) \
  add(list)                      \
  add(boxes)                     \
  add(oriented_boxes)            \
  add(bvh)                       \
  add(bottom_up)                 \
  add(obb_tree)                  \
  add(grid)                      \
  add(adaptive_grid)             \
  add(octree)                    \
  add(kd_median)                 \
  add(kd_sah)
// clang-format on

#define ORRERY_DECLARE(name) AcceleratorType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_ACCELERATORS(ORRERY_DECLARE)

std::span<const AcceleratorType> accelerator_types() {
  static const std::array types{ORRERY_ACCELERATORS(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
