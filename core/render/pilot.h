#pragma once

#include "core/render/backend.h"

namespace orrery {

struct Pilot {
  RenderStats stats;
  double share;  // fraction of the picture's pixels
};

// Traces `samples` samples of one block of 4 x 4 pixels in each tile, 1/64 of the picture. A small picture
// has several blocks per tile, 1024 pixels in all. Returns their statistics; the film is discarded. Depends
// on scene and plan alone. Throws Cancelled once control.stop is requested. REQUIRES: one sample if the plan
// has one.
Pilot trace_pilot(const PreparedScene& scene, const SettledPlan& plan, int samples, WorkerPool& pool,
                  const RenderControl& control);

// Traces at most `most` whole tiles from all parts of the picture. Unlike blocks, they cost as much as other
// tiles and reuse paths as the picture does. Otherwise as trace_pilot().
Pilot trace_tiles(const PreparedScene& scene, const SettledPlan& plan, int most, int samples,
                  WorkerPool& pool, const RenderControl& control);

}  // namespace orrery
