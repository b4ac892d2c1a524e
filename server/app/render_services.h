#pragma once

#include <atomic>
#include <chrono>

#include "core/render/renderer.h"
#include "server/app/admission.h"

namespace orrery {

// What all who render share. It outlives them.
struct RenderServices {
  WorkerPool& pool;
  Admission& admission;
  const std::atomic<bool>& draining;  // no new work; what goes on and on ends at its next frame
  const std::atomic<bool>& ends;      // all work ends at once
  std::atomic<std::uint64_t>& rays;   // traced so far

  // A frame; the caller has a ticket. Throws Cancelled.
  RenderResult render(const PreparedScene& scene, const Plan& plan, PixelFormat format,
                      const RenderControl& control) const {
    RenderResult result = render_frame(scene, plan, format, pool, control);
    rays += result.stats.counts.rays.total();
    return result;
  }
};

}  // namespace orrery
