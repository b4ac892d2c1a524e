#pragma once

#include "core/tuning/settle.h"

namespace orrery {

// The scene with the accelerator of a settled plan and the stages that it wants in front of it, which change
// no answer: prediction first, then reordering. Of these only the network takes time to make, once for a
// scene; adds the milliseconds spent building. Throws Cancelled once `stop` is requested.
template <class T>
World<T> staged_world(PreparedScene::Parts& parts, const SettledPlan& plan, double& build_ms,
                      std::stop_token stop = {});

}  // namespace orrery
