#pragma once

#include "core/render/renderer.h"

namespace orrery {

// Renders one frame in passes, each of which doubles the samples, until the certificate's bound is at most
// the error asked or the next pass would not end in time. Only whole passes count. The film keeps sums and is
// the one that the outcome's settings give.
//  - Error: what is decided depends on the picture alone, not on clocks. The looks share the certificate's
//    doubt: the k-th has 2^-k of it. Where the least contribution is free, pilots choose it, so that rays
//    that are not traced take an eighth of the error; where a pass tells that they take more, a sixteenth of
//    it is tried, three times at most. Where nothing can be proved, as of samples without a range, the
//    picture is made until the estimate is as asked; where a picture of that size proves less, also until
//    the bound is within a quarter of that. Both count as missed.
//  - Seconds: a pass is begun if it ends in time at the pace of the one before and a tenth more. The last may
//    have any even number of samples. One that takes longer all the same is given up, but not the first.
// Throws Cancelled once control.stop is requested. REQUIRES: has_budget(plan->asked).
RenderResult render_within_budget(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                                  const RenderControl& control);

// What render_frame() is foretold to take of the plan, whether it has a budget or not.
struct Forecast {
  BudgetOutcome outcome;    // its settings are those that the picture would come to
  Certificate certificate;  // that the picture would have
  double rays = 0;          // all, with those of pilots
  double seconds = 0;       // by the clock: of making ready and tracing, on the threads of the pool
};

// From ForecastPilots, and those that choose the least contribution. Errors are taken to fall as from 4
// samples to 16, at least with their root. What few pixels or paths alone bring is missed, and so are passes
// that trace weaker rays for it. Without a budget the samples are those of the plan, however long they take.
// What is foretold of rays and samples depends on the plan alone but where it has a budget of time. Throws
// Cancelled once control.stop is requested.
Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                  const RenderControl& control = {});

}  // namespace orrery
