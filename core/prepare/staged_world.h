#pragma once

#include "core/prepare/settle.h"

namespace orrery {

// Returns the scene with the accelerator of a settled plan, wrapped in the stages of the plan: occluder
// prediction first, then ray reordering. If the technique rasterizes, returns the triangles of the plan's
// image instead of these stages. Stages do not change results. The accelerator and the network
// predictor are built only if they are not cached. Adds the milliseconds spent building to `build_ms`.
// Thread-safe. Throws Cancelled if `stop` is requested, and the errors of AcceleratorType and make_screen().
template <class T>
World<T> staged_world(PreparedScene::Parts& parts, const SettledPlan& plan, double& build_ms,
                      std::stop_token stop = {});

}  // namespace orrery
