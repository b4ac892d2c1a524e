#pragma once

#include <memory>
#include <vector>

#include "core/base/error.h"
#include "core/render/certificate.h"

namespace orrery {

// What became of the budget of a picture.
struct BudgetOutcome {
  double error = 0, seconds = 0;  // asked; 0: was not
  OnMiss on_miss = OnMiss::best;
  RenderSettings settings;  // that give the picture again, without a budget
  bool error_met = true, seconds_met = true;
  double used_s = 0;                       // by the client's clock, in the end
  std::optional<double> least_error = {};  // that can be proved of a picture of that size
  std::optional<double> least_s = {};      // that the least picture would take, if it was given up for that
  std::string reason;                      // of a miss, or empty

  bool met() const { return error_met && seconds_met; }
  // What is done after rendering counts as well: that much time has been used when all is done.
  void end_at(double seconds_used);
};

class BudgetMissed : public Error {  // where that is to be an error
 public:
  BudgetMissed(BudgetOutcome outcome, const Certificate& certificate);
  const BudgetOutcome& outcome() const { return outcome_; }
  const Certificate& certificate() const { return certificate_; }

 private:
  BudgetOutcome outcome_;
  Certificate certificate_;
};

inline bool is_missed(const std::optional<BudgetOutcome>& budget) { return budget && !budget->met(); }
// Throws BudgetMissed if it was missed and that is to be an error.
void require_met(const BudgetOutcome& outcome, const Certificate& certificate);

struct RenderResult {
  Film film;
  RenderStats stats;
  Certificate certificate = {};
  std::optional<BudgetOutcome> budget = {};
};

// Renders one frame on the pool: every tile with all its samples, or with as many as the plan's budget takes,
// see render_within_budget(); throws BudgetMissed. Channels of the plan are kept with FilmStorage::sums
// alone. Throws Cancelled once control.stop is requested.
RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          WorkerPool& pool, const RenderControl& control = {});

// Samples a pixel after each pass of a progressive render. The last pass has all of the plan's; each before
// it has half as many as the next, rounded down, so that both halves of an even number are there and tell its
// error. A single sample that lies in the middle of its pixel is none of more, and then is no pass.
std::vector<int> progressive_samples(const Plan& plan);

// One frame whose samples are traced in passes. After each, the film is the one that all samples so far give
// when they are traced at once. Scene and pool outlive it.
class ProgressiveRender {
 public:
  // Makes the scene ready and takes the film's memory. Throws Cancelled once `stop` is requested.
  ProgressiveRender(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                    std::stop_token stop);

  // Traces what is missing to so many samples a pixel. Whatever it throws, such as Cancelled once
  // control.stop is requested: the film is then worth nothing. REQUIRES: more samples than before, at most
  // the plan's.
  void refine(int samples, const RenderControl& control = {});

  const Film& film() const { return film_; }
  Film take_film() { return std::move(film_); }  // after the last pass
  // Of all passes; the error is that of the film, where the last pass has at least doubled its samples.
  const RenderStats& stats() const { return stats_; }

 private:
  RenderStats stats_;
  const std::unique_ptr<Prepared> prepared_;
  Film film_;
  int samples_ = 0;
};

}  // namespace orrery
