#pragma once

#include "core/plan/request.h"
#include "core/render/renderer.h"

namespace orrery {

inline constexpr int kMaxAuditPixels = 1 << 20;

// Difference between a plan's picture and that of its technique without cuts, at random pixels, in the plan's
// space.
struct Audit {
  int pixels = 0;           // pixels drawn
  int differing = 0;        // pixels with a channel off by more than kEqualPixels
  double rms = 0, max = 0;  // differences of channels, over all pixels drawn
  double left_out = 0;      // error bound of the pixels without cuts, in radiance
  // Bound for the whole picture, for any distribution of the differences. Audited, or unknown if nothing
  // limits the error of a pixel.
  Bound bound = Bound::unknown();
};
inline constexpr double kEqualPixels = 1e-5;

// Renders independent, uniformly drawn pixels twice with the same samples: as requested, and with the full
// model. The full model has double precision, maximum depth, weaker rays and no clamp. A single centred
// sample is compared with 64 samples all over the pixel. Neither render reuses paths. The bound is that of
// UnitHistogram::upper_mean() with the certificate's doubt. Renders on the threads of `pool`; thread-safe.
// Throws InputError for budgets, layers and other views, the errors of Backend::prepare(), and Cancelled once
// control.stop is requested. REQUIRES: pixels in 1..kMaxAuditPixels.
Audit audit(const PreparedScene& scene, const RenderRequest& asked, int pixels, std::uint64_t seed,
            WorkerPool& pool, const RenderControl& control = {});

}  // namespace orrery
