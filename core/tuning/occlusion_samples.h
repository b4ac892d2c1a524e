#pragma once

#include <stop_token>
#include <vector>

#include "core/model/plan.h"
#include "core/model/world.h"
#include "core/stages/network_predictor.h"

namespace orrery {

// Returns shadow rays of tiles spread evenly over the plan's image, each with its first hit. At most 16,384.
// Throws Cancelled if `stop` is requested.
template <class T>
std::vector<OcclusionSample> sample_occlusion(const World<T>& world, const Plan& plan,
                                              std::stop_token stop = {});

}  // namespace orrery
