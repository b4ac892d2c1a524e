#pragma once

#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/render/certificate.h"

namespace orrery {

// Result of a picture's budget.
struct BudgetOutcome {
  double error = 0, seconds = 0;  // requested; 0: no limit
  OnMiss on_miss = OnMiss::best;
  RenderSettings settings;  // reproduce the picture without a budget
  bool error_met = true, seconds_met = true;
  double used_s = 0;                     // at the end, by the client's clock
  std::optional<double> min_error = {};  // smallest provable at this picture size
  std::optional<double> min_s = {};      // predicted time of a first pass given up
  std::string reason;                    // why it is missed, or empty

  bool met() const { return error_met && seconds_met; }
  // Sets the time used when all work is done. The budget may then be missed by work after rendering.
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

// Renders one frame on the pool. A plan with a budget gets as many samples as the budget takes and may throw
// BudgetMissed, see render_within_budget(). Only FilmStorage::sums keeps the plan's channels. Throws
// Cancelled once control.stop is requested.
RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          WorkerPool& pool, const RenderControl& control = {});

// Returns the samples per pixel after each pass of a progressive render. The last pass has all samples of the
// plan. Each pass before has half as many, rounded down, so that both halves of an even number estimate the
// error. A pass of one sample is left out if single samples lie in the pixel's middle, as it is not part of a
// larger set.
std::vector<int> progressive_samples(const Plan& plan);

// One frame that is rendered in passes. After each pass, the film equals one whose samples were traced at
// once. Scene and pool must outlive it.
class ProgressiveRender {
 public:
  // Prepares the scene and allocates the film. Throws Cancelled once `stop` is requested.
  ProgressiveRender(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                    std::stop_token stop);

  // Traces the samples missing to `samples` per pixel. Throws Cancelled once control.stop is requested. After
  // any exception the film is invalid. REQUIRES: more samples than before, at most the plan's.
  void refine(int samples, const RenderControl& control = {});

  const Film& film() const { return film_; }
  Film take_film() { return std::move(film_); }  // after the last pass
  // Returns the statistics of all passes. The error is that of the film if the last pass at least doubled its
  // samples.
  const RenderStats& stats() const { return stats_; }

 private:
  RenderStats stats_;
  const std::unique_ptr<Prepared> prepared_;
  Film film_;
  int samples_ = 0;
};

}  // namespace orrery
