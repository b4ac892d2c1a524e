#include "core/materials/registry.h"

#include <array>

namespace orrery {

// One line per type, in the order in which materials are numbered. Type `name` is defined in name.cpp.
// clang-format off
#define ORRERY_MATERIALS(add) \
  add(rough)                  \
  add(reflective)             \
  add(refractive)             \
  add(lambert)                \
  add(oren_nayar)             \
  add(metal)                  \
  add(glass)                  \
  add(plastic)                \
  add(metallic_roughness)     \
  add(cook_torrance)          \
  add(translucent)            \
  add(transparent)            \
  add(hall)                   \
  add(subsurface)             \
  add(coated)
// clang-format on

#define ORRERY_DECLARE(name) MaterialType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_MATERIALS(ORRERY_DECLARE)

std::span<const MaterialType> material_types() {
  static const std::array types{ORRERY_MATERIALS(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
