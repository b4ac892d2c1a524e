#pragma once

#include <functional>
#include <limits>
#include <span>
#include <stop_token>

#include "core/accuracy/render_stats.h"
#include "core/model/film.h"
#include "core/prepare/settle.h"
#include "core/render/executor.h"

// Interface of render backends. A backend renders tiles on threads of this process or elsewhere.
namespace orrery {

// Cancellation, progress and limits of a render.
struct RenderControl {
  std::stop_token stop = {};  // a stop request ends the render with Cancelled
  // Called after each tile, by several threads at once, with the number of finished tiles.
  std::function<void(int done, int total)> progress = {};
  bool spread = false;  // for ProgressiveRender: any prefix of the tile order covers the whole image
  // Returns the seconds since the client's request began. Thread-safe. If empty, time limits count from the
  // start of the render.
  std::function<double()> used_s = {};
  // Further limits of a render with a budget: number of rays, and seconds. Other renders ignore them.
  double max_rays = std::numeric_limits<double>::infinity();
  double max_s = std::numeric_limits<double>::infinity();
};

// Scene and settled plan, ready to render. Thread-safe if concurrent calls have different films and
// statistics.
class Prepared {
 public:
  virtual ~Prepared() = default;
  // Adds the samples of each tile to the film, and their cost and error statistics to `stats`. A tile whose
  // first sample is not 0 continues from the sums in the film. The film depends only on scene and plan, not
  // on the backend, the threads, the order of tiles or the SIMD width. Throws Cancelled once control.stop is
  // requested, std::bad_alloc, and the exceptions of the executor and of control.progress. After an
  // exception, the film is invalid. REQUIRES: the film stores sums, unless one call adds all samples of the
  // film.
  virtual void render(std::span<const TileView> tiles, Film& film, RenderStats& stats,
                      const RenderControl& control) = 0;
};

// Prepares scenes for rendering, e.g. on threads of this process. Thread-safe.
class Backend {
 public:
  virtual ~Backend() = default;
  // Prepares the scene if needed and adds the time to `stats`. Throws Cancelled once `stop` is requested,
  // std::bad_alloc, and the errors of AcceleratorType.
  virtual std::unique_ptr<Prepared> prepare(const PreparedScene& scene, const SettledPlan& plan,
                                            RenderStats& stats, std::stop_token stop) = 0;
};

// Returns a backend on the threads of `executor`, which must outlive the backend and its Prepared objects.
std::unique_ptr<Backend> threads_backend(Executor& executor);

}  // namespace orrery
