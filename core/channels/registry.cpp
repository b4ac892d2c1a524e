#include "core/channels/registry.h"

#include <array>

namespace orrery {

// One line per channel, implemented in the file of the same name.
// clang-format off
#define ORRERY_CHANNELS(add) \
  add(depth)                 \
  add(normal)                \
  add(position)              \
  add(uv)                    \
  add(object)                \
  add(footprint)
// clang-format on

#define ORRERY_DECLARE(name) ChannelType name##_channel();
#define ORRERY_ENTRY(name) name##_channel(),

ORRERY_CHANNELS(ORRERY_DECLARE)

std::span<const ChannelType> channel_types() {
  static const std::array types{ORRERY_CHANNELS(ORRERY_ENTRY)};
  return types;
}

}  // namespace orrery
