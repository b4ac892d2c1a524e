#pragma once

#include <stop_token>
#include <vector>

#include "core/model/plan.h"
#include "core/model/world.h"
#include "core/occlusion/network_predictor.h"

namespace orrery {

// Returns at most 16,384 shadow rays, each with its nearest hit. The rays are recorded while tiles spread
// evenly over the plan's image are traced. Throws Cancelled if `stop` is requested.
template <class T>
std::vector<OcclusionSample> sample_occlusion(const World<T>& world, const Plan& plan,
                                              std::stop_token stop = {});

}  // namespace orrery
