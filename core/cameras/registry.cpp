#include "core/cameras/registry.h"

#include <array>

namespace orrery {

// One line per camera type, implemented in the file of the same name.
// clang-format off
#define ORRERY_CAMERAS(add) \
  add(perspective)          \
  add(orthographic)         \
  add(panorama)
// clang-format on

#define ORRERY_DECLARE(name) CameraType name##_type();
#define ORRERY_ENTRY(name) name##_type(),

ORRERY_CAMERAS(ORRERY_DECLARE)

std::span<const CameraType> camera_types() {
  static const std::array types{ORRERY_CAMERAS(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
