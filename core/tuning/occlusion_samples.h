#pragma once

#include <stop_token>
#include <vector>

#include "core/model/plan.h"
#include "core/model/world.h"
#include "core/stages/network_predictor.h"

namespace orrery {

// Shadow rays of some tiles of the picture that the plan asks for, spread evenly over all of them, and what
// each met first. At most 16,384. Throws Cancelled once `stop` is requested.
template <class T>
std::vector<OcclusionSample> sample_occlusion(const World<T>& world, const Plan& plan,
                                              std::stop_token stop = {});

}  // namespace orrery
