#pragma once

#include <atomic>
#include <stop_token>

#include "core/render/renderer.h"
#include "server/app/admission.h"
#include "server/app/meters.h"

namespace orrery {

// What all renders share. It must outlive every render that uses it.
struct RenderServices {
  WorkerPool& pool;
  Admission& admission;
  Timer& timer;
  std::stop_token draining;  // no new work; what goes on and on ends at its next frame
  std::stop_token ends;      // all work ends at once
  Meters& meters;

  // A frame; the caller has a ticket. Throws Cancelled.
  RenderResult render(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                      const RenderControl& control) const {
    RenderResult result = render_frame(scene, plan, storage, pool, control);
    meters.rays += result.stats.counts.rays.total();
    meters.render.Observe((result.stats.build_ms + result.stats.trace_ms) / 1000);
    return result;
  }
};

}  // namespace orrery
