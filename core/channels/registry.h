#pragma once

#include <span>

#include "core/model/channel.h"

namespace orrery {

// Returns every film channel except radiance, in the order of the output file.
std::span<const ChannelType> channel_types();

}  // namespace orrery
