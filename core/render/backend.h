#pragma once

#include <functional>
#include <limits>
#include <span>
#include <stop_token>

#include "core/model/counts.h"
#include "core/model/film.h"
#include "core/render/film_error.h"
#include "core/render/worker_pool.h"
#include "core/tuning/settle.h"

// Where tiles are rendered: on threads of this machine, or elsewhere.
namespace orrery {

// How a caller follows a render.
struct RenderControl {
  std::stop_token stop = {};                               // a stop request ends it with Cancelled
  std::function<void(int done, int total)> progress = {};  // tiles; called from several threads at once
  bool background = false;                                 // others come first
  bool spread = false;   // any first part of the tiles that are rendered lies all over the picture
  Pass* pass = nullptr;  // as for_each() takes it
  // For budgets: seconds that the caller's client has waited, from any thread; those since the call if empty.
  std::function<double()> used_s = {};
  // What a budget may spend, whatever it says.
  double most_rays = std::numeric_limits<double>::infinity();
  double most_s = std::numeric_limits<double>::infinity();
};

// What a render took, and how far its film may be off.
struct RenderStats : FilmError {
  TraceCounts counts;
  const AcceleratorType* accelerator = nullptr;
  AcceleratorFacts structure;  // what the rays were traced with
  double build_ms = 0;         // making the scene ready, where it was not yet
  double trace_ms = 0;         // wall clock
  double cpu_ms = 0;           // of tracing, on all threads together
};

// A scene and a settled plan, ready to render.
class Prepared {
 public:
  virtual ~Prepared() = default;
  // Adds the samples that each tile names to the film; a tile whose first sample is not 0 goes on from the
  // sums that are there. Adds to stats what that took. The film depends on scene and plan alone: not on the
  // backend, its threads, their order or the machine's vector width. Throws Cancelled once a stop is
  // requested: the film is then worth nothing. REQUIRES: FilmStorage::sums unless each tile has all samples.
  virtual void render(std::span<const TileView> tiles, Film& film, RenderStats& stats,
                      const RenderControl& control) = 0;
};

class Backend {
 public:
  virtual ~Backend() = default;
  // Makes ready what is not yet and adds that to stats. Throws Cancelled once `stop` is requested.
  virtual std::unique_ptr<Prepared> prepare(const PreparedScene& scene, const SettledPlan& plan,
                                            RenderStats& stats, std::stop_token stop) = 0;
};

// The threads of this process. The pool outlives it.
std::unique_ptr<Backend> threads_backend(WorkerPool& pool);

}  // namespace orrery
