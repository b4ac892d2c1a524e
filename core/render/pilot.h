#pragma once

#include "core/render/backend.h"

namespace orrery {

struct Pilot {
  RenderStats stats;
  double share;  // of the picture's pixels
};

// Traces so many samples of one block of 4 x 4 pixels in each tile, somewhere in it, or of several in those
// of a small picture: 1/64 of it or 1024 pixels, from all over it. Returns what that tells; the picture
// itself is forgotten. Depends on scene and plan alone. Throws Cancelled once control.stop is requested.
// REQUIRES: one sample if the plan has one.
Pilot trace_pilot(const PreparedScene& scene, const SettledPlan& plan, int samples, WorkerPool& pool,
                  const RenderControl& control);

// Likewise whole tiles, so many at most, from all over the picture: what they take is what others take, and
// their paths are reused as in the picture, which is not so of blocks.
Pilot trace_tiles(const PreparedScene& scene, const SettledPlan& plan, int most, int samples,
                  WorkerPool& pool, const RenderControl& control);

}  // namespace orrery
