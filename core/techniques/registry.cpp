#include "core/techniques/registry.h"

#include <array>

namespace orrery {

// One line per type. NAME.cpp defines NAME_type().
// clang-format off
#define ORRERY_TECHNIQUES(add) \
  add(raycast)                 \
  add(whitted)                 \
  add(distributed)             \
  add(path)                    \
  add(flat)                    \
  add(gouraud)                 \
  add(phong)
// clang-format on

#define ORRERY_DECLARE(name) TechniqueType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_TECHNIQUES(ORRERY_DECLARE)

std::span<const TechniqueType> technique_types() {
  static const std::array types{ORRERY_TECHNIQUES(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
