#pragma once

#include <span>

#include "core/model/channel.h"

namespace orrery {

// Every film channel beside radiance, in the order in which they are written to files.
std::span<const ChannelType> channel_types();

}  // namespace orrery
