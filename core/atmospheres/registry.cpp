#include "core/atmospheres/registry.h"

#include <array>

namespace orrery {

// One line per atmosphere type, implemented in the file of the same name.
// clang-format off
#define ORRERY_ATMOSPHERES(add) \
  add(depth_cue)                \
  add(fog)
// clang-format on

#define ORRERY_DECLARE(name) AtmosphereType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_ATMOSPHERES(ORRERY_DECLARE)

std::span<const AtmosphereType> atmosphere_types() {
  static const std::array types{ORRERY_ATMOSPHERES(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
