#pragma once

#include "core/render/renderer.h"

namespace orrery {

// Renders one frame in passes, each of which doubles the samples. Ends when the certificate's bound is at
// most the requested error, or when the next pass would end late. Only complete passes count. The film keeps
// sums and equals the film of the outcome's settings.
//  - Error: decisions depend on the picture alone, not on clocks. The certificates of all passes share the
//    doubt: the k-th has 2^-k of it. If min_contribution is free, pilots choose it so that rays that are not
//    traced take an eighth of the error. If a pass shows that they take more, min_contribution is divided by
//    16, at most three times. If nothing can be proved, e.g. because samples have no range, passes continue
//    until the estimate meets the error. If the smallest provable error is larger than the requested one,
//    they continue until the bound is also at most 1.25 times the smallest. Both cases count as
//    missed.
//  - Seconds: a pass starts if it ends in time at the pace of the pass before plus a tenth. The last pass may
//    have any even number of samples. A pass that is late is given up, unless it is the first.
// Throws Cancelled once control.stop is requested. REQUIRES: has_budget(plan->asked).
RenderResult render_within_budget(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                                  const RenderControl& control);

// Predicted cost and result of render_frame(), with or without a budget.
struct Forecast {
  BudgetOutcome outcome;    // with the predicted settings
  Certificate certificate;  // predicted for the picture
  double rays = 0;          // all rays, including those of pilots
  double seconds = 0;       // wall clock, to prepare and trace on the pool
};

// Predicts from ForecastPilots and from the pilots that choose min_contribution. Errors are assumed to fall
// as from 4 to 16 samples, and at least with the root of the samples. Light that only few pixels or paths see
// is missed, and so are the passes that it would cause. Without a budget, the samples are those of the plan.
// Predicted rays and samples depend on the plan alone, unless it has a time limit. Throws Cancelled once
// control.stop is requested.
Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                  const RenderControl& control = {});

}  // namespace orrery
