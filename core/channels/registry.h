#pragma once

#include <span>

#include "core/model/channel.h"

// core/channels: film channels that record properties of the first hits of camera rays.
//
// All functions are thread-safe and report no errors.
namespace orrery {

// Returns every film channel except radiance, in the order of the output file. The span is valid until the
// program exits.
std::span<const ChannelType> channel_types();

}  // namespace orrery
