#pragma once

#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/render/certificate.h"

// Rendering of settled plans. This folder owns the render threads (worker_pool.h), backends (backend.h),
// budgets and forecasts (budget.h), pilots (pilot.h, forecast_pilots.h), error certificates (certificate.h)
// and the encoding of films (views.h). A settled plan is a plan whose accelerator is final: settle() returns
// it as a SettledPlan, see core/tuning/settle.h.
//
// Threads: WorkerPool, Backend and Prepared are thread-safe, and all free functions may be called from any
// thread at the same time, also with the same PreparedScene and pool. Functions that render block the calling
// thread until their result is complete, and trace tiles on the threads of the pool. A ProgressiveRender or
// TileRenderer is used by one thread at a time. ForecastPilots are immutable once constructed.
//
// Errors: functions that render throw Cancelled once a stop is requested, InputError if an acceleration
// structure exceeds a limit, std::bad_alloc if memory runs out, and the exceptions of SlotLease::renew() and
// of the callbacks in RenderControl. Only render_frame(), render_within_budget() and require_met() throw
// BudgetMissed.
namespace orrery {

// Result of a render with a budget.
struct BudgetOutcome {
  double error = 0, seconds = 0;  // requested limits; 0: no limit
  OnMiss on_miss = OnMiss::best;
  RenderSettings settings;  // a request with them renders the same image without a budget
  bool error_met = true, seconds_met = true;
  double used_s = 0;                     // seconds used, see RenderControl::used_s
  std::optional<double> min_error = {};  // smallest provable error at this image size
  std::optional<double> min_s = {};      // predicted end of an abandoned first pass, seconds
  std::string reason;                    // why the budget was missed; empty if it was met

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

// Renders one frame on the pool. With a budget, returns render_within_budget(): the budget determines the
// samples, the film stores sums, and BudgetMissed may be thrown. Only FilmStorage::sums stores the plan's
// channels.
RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          WorkerPool& pool, const RenderControl& control = {});

// Returns the samples per pixel after each pass of a progressive render, ascending. The last number is the
// plan's samples. Each other number is half of the next, rounded down, so that the two halves of an even
// number give an error estimate. A pass of one sample is omitted if a single sample is at the pixel centre,
// because this sample is not part of a larger set.
std::vector<int> progressive_samples(const Plan& plan);

// One frame that is rendered in passes. After each pass, the film is identical to a film whose samples were
// traced in a single pass. `scene` and `pool` must outlive the object. Used by one thread at a time.
class ProgressiveRender {
 public:
  // Prepares the scene and allocates the film. Throws Cancelled once `stop` is requested, InputError if an
  // acceleration structure exceeds a limit, and std::bad_alloc.
  ProgressiveRender(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                    std::stop_token stop);

  // Traces samples until each pixel has `samples`. Throws the errors of Prepared::render(). After an
  // exception, the film is invalid. REQUIRES: `samples` exceeds the samples of the film, and is at most the
  // plan's samples.
  void refine(int samples, const RenderControl& control = {});

  const Film& film() const { return film_; }
  Film take_film() { return std::move(film_); }  // after the last pass
  // Returns the statistics of all passes. The error estimate is known only if the number of samples is even
  // and the last pass at least doubled it.
  const RenderStats& stats() const { return stats_; }

 private:
  RenderStats stats_;
  const std::unique_ptr<Prepared> prepared_;
  Film film_;
  int samples_ = 0;
};

}  // namespace orrery
