#pragma once

#include "core/budget/renderer.h"

namespace orrery {

// Renders one frame in passes. Each pass at least doubles the samples per pixel. Stops after the first pass
// whose certificate meets the error limit, at the maximum number of samples, or if another pass would exceed
// the time limit, control.max_rays or the memory. Incomplete passes are discarded. The film stores sums. It
// is identical to the film of a render with the outcome's settings.
//  - Error limit: decisions depend on the image alone, not on clocks. The certificates of all passes share
//    the error probability kAlpha: pass k gets 2^-k of it. If min_contribution is free, pilots choose it so
//    that untraced rays cause at most 1/16 of the error limit. If a pass shows that they cause more than 1/8,
//    min_contribution is divided by 16 and the passes start again, at most three times.
//  - Unbounded radiance: if a sample has no largest radiance, as for paths in linear radiance, the bound that
//    the samples estimate from the spread of their errors must meet the limit. It assumes that the samples
//    found all bright light.
//  - Unprovable error limit: if there is no bound, passes continue until the estimated error is within the
//    limit. If the smallest provable error exceeds the limit, passes also continue until the bound is at most
//    1.25 times that error. Both cases count as missed. If `on_miss` is `fail`, no pass starts.
//  - Time limit: a pass starts only if it would end in time at 1.1 times the cost per sample of the previous
//    pass. The last pass may have any even number of samples. A pass that exceeds the time limit is
//    abandoned, and the image of the previous pass is returned. The first pass is abandoned only if `on_miss`
//    is `fail`.
// Throws BudgetMissed if the budget is missed and `on_miss` is `fail`, and the other errors in renderer.h.
// REQUIRES: has_budget(plan->asked).
RenderResult render_within_budget(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                                  const RenderControl& control);

// Predicted cost and result of render_frame(), with or without a budget.
struct Forecast {
  BudgetOutcome outcome;    // predicted outcome and settings
  Certificate certificate;  // predicted certificate of the image
  double rays = 0;          // all rays, including those of pilots
  double seconds = 0;       // wall-clock time to prepare and trace on the executor
};

// Predicts cost and error from ForecastPilots and from the pilots that choose min_contribution. Assumes that
// errors decrease at the rate measured from 4 to 16 samples, and at least with the square root of the
// samples. The pilots miss light that reaches only a few pixels or paths. The forecast then misses the passes
// that this light requires. Without a budget, the plan determines the samples. Predicted rays and samples
// depend only on scene and plan, unless the plan has a time limit. Throws the errors in renderer.h except
// BudgetMissed.
Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                  const RenderControl& control = {});

}  // namespace orrery
