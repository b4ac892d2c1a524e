#pragma once

#include "core/render/backend.h"

namespace orrery {

// Result of a pilot, a measuring render of a subset of the pixels.
struct Pilot {
  RenderStats stats;
  double share;  // traced fraction of the image's pixels, in (0, 1]
};

// Traces `samples` samples per pixel in one block of 4 x 4 pixels per tile, about 1/64 of the image. An image
// with fewer than 64 tiles has ceil(64 / tiles) blocks per tile, or all blocks of a tile that has fewer.
// Returns the statistics of these pixels and discards the film. The result, except times, depends only on
// scene, plan and `samples`. Throws the
// errors in renderer.h except BudgetMissed. Uses only control.stop. REQUIRES:
// `samples` is 1 if plan->samples is 1.
Pilot trace_pilot(const PreparedScene& scene, const SettledPlan& plan, int samples, Executor& executor,
                  const RenderControl& control);

// Like trace_pilot(), but traces at most `most` whole tiles from all parts of the image. Unlike blocks, whole
// tiles have the same cost per pixel and the same path reuse as the image.
Pilot trace_tiles(const PreparedScene& scene, const SettledPlan& plan, int most, int samples,
                  Executor& executor, const RenderControl& control);

}  // namespace orrery
