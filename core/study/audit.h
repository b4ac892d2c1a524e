#pragma once

#include "core/plan/request.h"
#include "core/render/renderer.h"

namespace orrery {

inline constexpr int kMostAuditPixels = 1 << 20;

// Pixels of a plan's picture beside those that its technique makes without cuts, in the plan's space.
struct Audit {
  int pixels = 0;           // that were drawn
  int differing = 0;        // of these, by more than kEqualPixels in some channel
  double rms = 0, max = 0;  // of the differences of a channel, over all of these
  double left_out = 0;      // the most by which the pixels without cuts may be off themselves, in radiance
  // Of the whole picture, however its differences are distributed: audited, or unknown where nothing limits
  // how far one pixel may be off.
  Bound bound = Bound::unknown();
};
inline constexpr double kEqualPixels = 1e-5;

// Renders pixels that are drawn at random, evenly and independently, twice by the same samples: as asked, and
// by the whole model in double precision, as deep as rays may go, with weaker rays and nothing clamped. Where
// the only sample lies in the pixel's middle, it is compared with 64 all over the pixel. Paths share nothing
// in either. The bound is that of UnitHistogram::upper_mean() with the certificate's doubt. Throws what
// make_plan() does; InputError for budgets and other views; Cancelled once control.stop is requested.
// REQUIRES: pixels in 1..kMostAuditPixels.
Audit audit(const PreparedScene& scene, const RenderRequest& asked, int pixels, std::uint64_t seed,
            WorkerPool& pool, const RenderControl& control = {});

}  // namespace orrery
