#include "core/textures/registry.h"

#include <array>

namespace orrery {

// One line per type. Type `name` is defined in name.cpp.
// clang-format off
#define ORRERY_TEXTURES(add) \
  add(checker)               \
  add(image_map)             \
  add(uniform)               \
  add(noise)                 \
  add(marble)                \
  add(wood)
// clang-format on

#define ORRERY_DECLARE(name) TextureType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_TEXTURES(ORRERY_DECLARE)

std::span<const TextureType> texture_types() {
  static const std::array types{ORRERY_TEXTURES(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
