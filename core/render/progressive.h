#pragma once

#include <memory>
#include <vector>

#include "core/render/backend.h"

namespace orrery {

// Renders the samples of the plan in one pass and adds cost and error statistics to `stats`. Ignores budgets:
// see render_frame(). Only FilmStorage::sums stores the plan's channels. Throws the errors of
// Prepared::render(), and InputError if an acceleration structure exceeds a limit.
Film render_film(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage, Executor& executor,
                 RenderStats& stats, const RenderControl& control);

// Returns the samples per pixel after each pass of a progressive render, ascending. The last number is the
// plan's samples. Each other number is half of the next, rounded down, so that the two halves of an even
// number give an error estimate. A pass of one sample is omitted if a single sample is at the pixel centre,
// because this sample is not part of a larger set.
std::vector<int> progressive_samples(const Plan& plan);

// One frame that is rendered in passes. After each pass, the film is identical to a film whose samples were
// traced in a single pass. `scene` and `executor` must outlive the object. Used by one thread at a time.
class ProgressiveRender {
 public:
  // Prepares the scene and allocates the film. Throws Cancelled once `stop` is requested, InputError if an
  // acceleration structure exceeds a limit, and std::bad_alloc.
  ProgressiveRender(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
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
