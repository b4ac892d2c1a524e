#pragma once

#include "core/render/renderer.h"

namespace orrery {

// Renders one frame in passes, each of which doubles the samples. Stops when the certificate's bound is at
// most the requested error, or when the next pass would miss the time limit. Incomplete passes are discarded.
// The film stores sums and is identical to that of a render with the outcome's settings.
//  - Error: decisions depend on the image alone, not on clocks. The certificates of all passes share the
//    error probability: the k-th gets 2^-k of it. If min_contribution is free, pilots choose it so that
//    untraced rays cause at most an eighth of the error. If a pass shows that they cause more,
//    min_contribution is divided by 16, at most three times. If no bound can be proved, e.g. because samples
//    have no range, passes continue until the estimate is within the error limit. If the smallest provable
//    error exceeds the requested one, passes continue until the bound is also at most 1.25 times the smallest
//    provable error. Both cases count as missed.
//  - Time limit: a pass starts only if it would end in time at 1.1 times the cost per sample of the previous
//    pass. The last pass may have any even number of samples. A late pass is abandoned. A late first pass is
//    completed if `on_miss` is `best`.
// Throws BudgetMissed if the budget is missed and `on_miss` is `fail`, and Cancelled once control.stop is
// requested. REQUIRES: has_budget(plan->asked).
RenderResult render_within_budget(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                                  const RenderControl& control);

// Predicted cost and result of render_frame(), with or without a budget.
struct Forecast {
  BudgetOutcome outcome;    // with the predicted settings
  Certificate certificate;  // predicted for the image
  double rays = 0;          // all rays, including those of pilots
  double seconds = 0;       // wall-clock time to prepare and trace on the pool
};

// Predicts cost and error from ForecastPilots and from the pilots that choose min_contribution. Assumes that
// errors decrease at the rate measured from 4 to 16 samples, and at least with the square root of the
// samples. The pilots miss light that reaches only a few pixels or paths, and the forecast misses the passes
// that such light causes. Without a budget, the plan determines the samples. Predicted rays and samples
// depend only on scene and plan, unless the plan has a time limit. Throws Cancelled once control.stop is
// requested.
Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                  const RenderControl& control = {});

}  // namespace orrery
