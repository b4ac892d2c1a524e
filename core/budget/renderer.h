#pragma once

#include <memory>
#include <vector>

#include "core/accuracy/certificate.h"
#include "core/base/error.h"
#include "core/render/backend.h"

// Rendering of settled plans. core/render traces tiles (backend.h) and encodes films (views.h), core/accuracy
// computes error certificates (certificate.h), and this folder owns budgets and forecasts (budget.h) and
// pilots (pilot.h, forecast_pilots.h). A settled plan is a plan whose accelerator is final: settle() returns
// it as a SettledPlan, see core/prepare/settle.h.
//
// Threads: Backend and Prepared are thread-safe, and all free functions may be called from any thread at the
// same time, also with the same PreparedScene and executor. Functions that render block the calling thread
// until their result is complete, and trace tiles on the threads of the executor. A ProgressiveRender or
// TileRenderer is used by one thread at a time. ForecastPilots are immutable once constructed.
//
// Errors: functions that render throw Cancelled once a stop is requested, InputError if an acceleration
// structure exceeds a limit, std::bad_alloc if memory runs out, and the exceptions of the executor and of the
// callbacks in RenderControl. Only render_frame(), render_within_budget() and require_met() throw
// BudgetMissed.
namespace orrery {

// Result of a render with a budget.
struct BudgetOutcome {
  double error = 0, seconds = 0;  // requested limits; 0: no limit
  OnMiss on_miss = OnMiss::best;
  RenderSettings settings;  // a request with them renders the same image without a budget
  bool error_met = true, seconds_met = true;
  double used_s = 0;                        // seconds used, see RenderControl::used_s
  Bound::Kind kind = Bound::Kind::unknown;  // kind of the bound that was compared with the error limit
  std::optional<double> min_error = {};     // smallest provable error at this image size
  std::optional<double> min_s = {};         // predicted end of an abandoned first pass, seconds
  std::string reason;                       // why the budget was missed; empty if it was met

  bool met() const { return error_met && seconds_met; }
  // Sets used_s to the time at the end of encoding. If that exceeds the time limit, the limit counts as
  // missed.
  void end_at(double seconds_used);
};

// Thrown on a budget miss if `on_miss` is `fail`.
class BudgetMissed : public Error {
 public:
  BudgetMissed(BudgetOutcome outcome, const Certificate& certificate);
  const BudgetOutcome& outcome() const { return outcome_; }
  const Certificate& certificate() const { return certificate_; }

 private:
  BudgetOutcome outcome_;
  Certificate certificate_;
};

inline bool is_missed(const std::optional<BudgetOutcome>& budget) { return budget && !budget->met(); }
// Throws BudgetMissed if the budget is missed and `on_miss` is `fail`.
void require_met(const BudgetOutcome& outcome, const Certificate& certificate);

struct RenderResult {
  Film film;
  RenderStats stats;
  Certificate certificate = {};
  std::optional<BudgetOutcome> budget = {};
};

// Renders one frame on the executor. With a budget, returns render_within_budget(): the budget determines the
// samples, the film stores sums, and BudgetMissed may be thrown. Only FilmStorage::sums stores the plan's
// channels.
RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          Executor& executor, const RenderControl& control = {});

}  // namespace orrery
