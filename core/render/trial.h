#pragma once

#include "core/model/plan.h"
#include "core/model/technique.h"

namespace orrery {

// Traces up to `most` tiles of the picture that the plan asks for, spread over it, one sample a pixel.
// Returns what that took.
template <class T>
TraceCounts try_tiles(const World<T>& world, const Plan& plan, int most);

// Relative time that the counted work takes with a structure.
double cost_of(const AcceleratorType& type, const AcceleratorCounts& counts);

}  // namespace orrery
