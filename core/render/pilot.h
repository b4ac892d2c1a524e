#pragma once

#include "core/render/backend.h"

namespace orrery {

struct Pilot {
  RenderStats stats;
  double share;  // traced fraction of the image's pixels
};

// Traces `samples` samples of one block of 4 x 4 pixels in each tile, 1/64 of the image. A small image has
// several blocks per tile, at least 1024 pixels in all. Returns the statistics of these pixels and discards
// the film. The result, except times, depends only on scene and plan. Throws Cancelled once control.stop is
// requested. REQUIRES: one sample if the plan has one.
Pilot trace_pilot(const PreparedScene& scene, const SettledPlan& plan, int samples, WorkerPool& pool,
                  const RenderControl& control);

// Traces at most `most` whole tiles from all parts of the image. Unlike blocks, they have the cost per pixel
// and the path reuse of the image. Otherwise like trace_pilot().
Pilot trace_tiles(const PreparedScene& scene, const SettledPlan& plan, int most, int samples,
                  WorkerPool& pool, const RenderControl& control);

}  // namespace orrery
