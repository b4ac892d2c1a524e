#pragma once

#include "core/tuning/settle.h"

namespace orrery {

// Returns the scene with the accelerator of a settled plan, wrapped in its stages: occluder prediction first,
// then ray reordering. Stages do not change results. Only the network takes time to build, once per scene.
// Adds the milliseconds spent building to `build_ms`. Throws Cancelled if `stop` is requested.
template <class T>
World<T> staged_world(PreparedScene::Parts& parts, const SettledPlan& plan, double& build_ms,
                      std::stop_token stop = {});

}  // namespace orrery
