#include "core/shapes/registry.h"

#include <array>

namespace orrery {

// One line per type, in the order in which primitives are numbered. NAME.cpp defines NAME_type().
// clang-format off
#define ORRERY_SHAPES(add) \
  add(sphere)              \
  add(plane)               \
  add(triangle)            \
  add(mesh)                \
  add(box)                 \
  add(disk)                \
  add(rectangle)           \
  add(cylinder)            \
  add(cone)                \
  add(torus)               \
  add(patch)               \
  add(nurbs)
// clang-format on

#define ORRERY_DECLARE(name) ShapeType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_SHAPES(ORRERY_DECLARE)

std::span<const ShapeType> shape_types() {
  static const std::array types{ORRERY_SHAPES(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
