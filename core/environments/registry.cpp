#include "core/environments/registry.h"

#include <array>

namespace orrery {

// One line per environment type, implemented in the file of the same name.
// clang-format off
#define ORRERY_ENVIRONMENTS(add) \
  add(constant)                  \
  add(gradient)                  \
  add(image)
// clang-format on

#define ORRERY_DECLARE(name) EnvironmentType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_ENVIRONMENTS(ORRERY_DECLARE)

std::span<const EnvironmentType> environment_types() {
  static const std::array types{ORRERY_ENVIRONMENTS(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
