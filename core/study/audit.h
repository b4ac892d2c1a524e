#pragma once

#include "core/plan/request.h"
#include "core/render/renderer.h"

namespace orrery {

inline constexpr int kMaxAuditPixels = 1 << 20;

// Difference at random pixels between the image of a plan and that of its technique without cuts, in the
// plan's error metric.
struct Audit {
  int pixels = 0;           // pixels drawn
  int differing = 0;        // pixels with a channel that differs by more than kEqualPixels
  double rms = 0, max = 0;  // channel differences, over all pixels drawn
  double left_out = 0;      // largest error bound of a pixel without cuts, in radiance
  // Bound for the whole image, valid for any distribution of the differences. Its kind is audited, or unknown
  // if the error of a pixel is unbounded.
  Bound bound = Bound::unknown();
};
inline constexpr double kEqualPixels = 1e-5;

// Renders independent, uniformly drawn pixels twice with the same samples: as requested, and with the full
// model. The full model has double precision, maximum depth, a smaller min_contribution and no clamp. If the
// request has a single sample at the pixel centre, the full model has 64 samples distributed over the pixel.
// Neither render reuses paths. The bound is that of UnitHistogram::upper_mean() with the confidence of
// certificates. Renders on the threads of `pool`; thread-safe. Throws InputError for budgets, layers and
// views other than `picture`, the errors of Backend::prepare(), and Cancelled once control.stop is requested.
// REQUIRES: pixels in [1, kMaxAuditPixels].
Audit audit(const PreparedScene& scene, const RenderRequest& asked, int pixels, std::uint64_t seed,
            WorkerPool& pool, const RenderControl& control = {});

}  // namespace orrery
