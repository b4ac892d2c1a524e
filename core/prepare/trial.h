#pragma once

#include <stop_token>

#include "core/model/plan.h"
#include "core/model/technique.h"

namespace orrery {

// Traces up to `most` tiles spread over the plan's image, one sample per pixel. Returns the operation counts.
// Stops soon after a million rays. The last ray is the same for every accelerator. Throws Cancelled if `stop`
// is requested.
template <class T>
TraceCounts try_tiles(const World<T>& world, const Plan& plan, int most, std::stop_token stop = {});

}  // namespace orrery
