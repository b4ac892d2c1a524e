#pragma once

#include "core/render/backend.h"

namespace orrery {

struct RenderResult {
  Film film;
  RenderStats stats;
};

// Renders one frame on the pool: every tile with all its samples. Channels of the plan are kept with
// FilmStorage::sums alone. Throws Cancelled once control.stop is requested.
RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          WorkerPool& pool, const RenderControl& control = {});

}  // namespace orrery
