#pragma once

#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/render/certificate.h"

namespace orrery {

// Result of a render with a budget.
struct BudgetOutcome {
  double error = 0, seconds = 0;  // requested; 0: no limit
  OnMiss on_miss = OnMiss::best;
  RenderSettings settings;  // reproduce the image without a budget
  bool error_met = true, seconds_met = true;
  double used_s = 0;                     // at the end, see RenderControl::used_s
  std::optional<double> min_error = {};  // smallest provable error at this image size
  std::optional<double> min_s = {};      // predicted time of an abandoned first pass
  std::string reason;                    // why the budget was missed; empty if it was met

  bool met() const { return error_met && seconds_met; }
  // Sets the time used up to the end of encoding. May turn a met time limit into a missed one.
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

// Renders one frame on the pool. If the plan has a budget, the budget determines the samples, and
// BudgetMissed may be thrown; see render_within_budget(). Only FilmStorage::sums stores the plan's channels.
// Throws Cancelled once control.stop is requested.
RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          WorkerPool& pool, const RenderControl& control = {});

// Returns the samples per pixel after each pass of a progressive render. The last pass has all samples of the
// plan. Each earlier pass has half as many as the next, rounded down, so that the two halves of an even
// number give an error estimate. A pass of one sample is omitted if a single sample is at the pixel centre,
// as it is not part of a larger set.
std::vector<int> progressive_samples(const Plan& plan);

// One frame that is rendered in passes. After each pass, the film is identical to one whose samples were
// traced in a single pass. Scene and pool must outlive it.
class ProgressiveRender {
 public:
  // Prepares the scene and allocates the film. Throws Cancelled once `stop` is requested.
  ProgressiveRender(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                    std::stop_token stop);

  // Traces samples until each pixel has `samples`. Throws Cancelled once control.stop is requested. After any
  // exception the film is invalid. REQUIRES: more samples than before, at most the plan's.
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
