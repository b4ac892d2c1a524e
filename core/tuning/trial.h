#pragma once

#include <stop_token>

#include "core/model/plan.h"
#include "core/model/technique.h"

namespace orrery {

// Traces up to `most` tiles of the picture that the plan asks for, spread over it, one sample a pixel.
// Returns what that took. Ends after a million rays, or a little more: the same ones for every accelerator.
// Throws Cancelled once `stop` is requested.
template <class T>
TraceCounts try_tiles(const World<T>& world, const Plan& plan, int most, std::stop_token stop = {});

}  // namespace orrery
