#pragma once

#include "core/budget/renderer.h"
#include "core/plan/request.h"

namespace orrery {

inline constexpr int kMaxAuditPixels = 1 << 20;

// Difference at random pixels between the image of a plan and the image of the same technique without cuts,
// in the plan's error metric.
struct Audit {
  int pixels = 0;           // pixels drawn, with replacement
  int differing = 0;        // pixels with a channel that differs by more than kEqualPixels
  double rms = 0, max = 0;  // channel differences, over all pixels drawn
  double left_out = 0;      // bound on the error of any drawn pixel without cuts, in radiance
  // Bound for the whole image, valid for any distribution of the differences. Its kind is audited, or unknown
  // if the error of a pixel is unbounded.
  Bound bound = Bound::unknown();
};
inline constexpr double kEqualPixels = 1e-5;  // largest channel difference that counts as equal

// Renders independent, uniformly drawn pixels twice with the same samples: as requested, and without cuts.
// The render without cuts has all stages, double precision, maximum depth, no clamp, and a min_contribution
// of at most 1e-4, or 0 for paths. If the request has a single sample at the pixel centre, the render without
// cuts has 64 samples distributed over the pixel. Neither render reuses paths. The bound is computed by
// UnitHistogram::upper_mean() with the confidence Certificate::kConfidence. Renders on the threads of `pool`.
// Thread-safe. Throws InputError for budgets, layers and views other than `picture`, and the errors of
// Backend::prepare() and Prepared::render(). REQUIRES: pixels in [1, kMaxAuditPixels].
Audit audit(const PreparedScene& scene, const RenderRequest& asked, int pixels, std::uint64_t seed,
            Executor& executor, const RenderControl& control = {});

}  // namespace orrery
