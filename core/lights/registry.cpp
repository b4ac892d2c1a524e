#include "core/lights/registry.h"

#include <array>

namespace orrery {

// One line per light type, implemented in the file of the same name.
// clang-format off
#define ORRERY_LIGHTS(add) \
  add(directional)         \
  add(line)                \
  add(point)               \
  add(spot)
// clang-format on

#define ORRERY_DECLARE(name) LightType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_LIGHTS(ORRERY_DECLARE)

std::span<const LightType> light_types() {
  static const std::array types{ORRERY_LIGHTS(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
