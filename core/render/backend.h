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

// Interface of a render backend, which renders tiles on threads of this process or elsewhere.
namespace orrery {

// Cancellation, progress and limits of a render.
struct RenderControl {
  std::stop_token stop = {};                               // a stop request ends the render with Cancelled
  std::function<void(int done, int total)> progress = {};  // counts tiles; called concurrently
  bool background = false;                                 // other renders have priority
  bool spread = false;                                     // order tiles so that any prefix covers the image
  SlotLease* lease = nullptr;                              // see WorkerPool::for_each()
  // Returns the seconds since the client's request began. Thread-safe. If empty, budgets count from the start
  // of the render.
  std::function<double()> used_s = {};
  // Limits of a render with a budget, in addition to those of the request.
  double max_rays = std::numeric_limits<double>::infinity();
  double max_s = std::numeric_limits<double>::infinity();
};

// Cost of a render and error statistics of its film.
struct RenderStats : FilmError {
  TraceCounts counts;
  const AcceleratorType* accelerator = nullptr;
  AcceleratorFacts structure;  // structure that traced the rays
  double build_ms = 0;         // time to prepare the scene, if needed
  double trace_ms = 0;         // wall clock
  double cpu_ms = 0;           // tracing, summed over all threads
};

// Scene and settled plan, ready to render. Thread-safe if concurrent calls have different films and
// statistics.
class Prepared {
 public:
  virtual ~Prepared() = default;
  // Adds the samples of each tile to the film, and their cost to `stats`. A tile whose first sample is not 0
  // continues from the sums in the film. The film depends only on scene and plan, not on the backend, its
  // threads, their order or the SIMD width. Throws Cancelled once a stop is requested, and the exceptions of
  // SlotLease::renew(). The film is then invalid. REQUIRES: FilmStorage::sums, unless one call adds
  // all samples of the film.
  virtual void render(std::span<const TileView> tiles, Film& film, RenderStats& stats,
                      const RenderControl& control) = 0;
};

// Prepares scenes for rendering, e.g. on a thread pool. Thread-safe.
class Backend {
 public:
  virtual ~Backend() = default;
  // Prepares the scene if needed and adds the cost to `stats`. Throws Cancelled once `stop` is requested, and
  // the errors of AcceleratorType.
  virtual std::unique_ptr<Prepared> prepare(const PreparedScene& scene, const SettledPlan& plan,
                                            RenderStats& stats, std::stop_token stop) = 0;
};

// Returns a backend on the threads of `pool`, which must outlive it.
std::unique_ptr<Backend> threads_backend(WorkerPool& pool);

}  // namespace orrery
