#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "core/image/image.h"
#include "core/model/counts.h"
#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// A scene with what rendering it has built so far (its shapes in the render's precision, its accelerators),
// kept for the next frame. Safe to use from any number of threads; each part is built once.
class PreparedScene {
 public:
  explicit PreparedScene(std::shared_ptr<const Scene> scene);
  ~PreparedScene();

  const Scene& scene() const;
  std::shared_ptr<const Scene> shared_scene() const;

  // Of a scene that moves: for so many moments, those asked for last, what was built is kept.
  static constexpr std::size_t kMoments = 2;

  struct Parts;
  Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

// The threads that render. One for a process; frames from several callers share them. Safe from any thread.
class WorkerPool {
 public:
  // threads 0: one a core.
  explicit WorkerPool(int threads = 0);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  int threads() const;

  // Has `task` done by one of the threads, soon. It must not throw and must not wait.
  void enqueue(bool background, std::function<void()> task);
  // Calls work(step, thread) for each 0 <= step < count on the threads, 0 <= thread < threads(), and returns
  // after the last. Callers share the threads evenly; those in the background have what the others leave.
  // Once a step returns false or throws, no more are begun; what was thrown first is thrown here.
  using Step = std::function<bool(int step, int thread)>;
  void for_each(int count, bool background, const Step& work);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// How a caller follows a render.
struct RenderControl {
  std::stop_token stop = {};                               // a stop request ends it with Cancelled
  std::function<void(int done, int total)> progress = {};  // tiles; called from several threads at once
  bool background = false;                                 // others come first
};

struct RenderStats {
  TraceCounts counts;
  const AcceleratorType* accelerator = nullptr;
  double mean_cut = 0, max_cut = 0;  // weight of rays not traced, a pixel: mean and largest
  AcceleratorFacts structure;        // what the rays were traced with
  double build_ms = 0;               // making the scene ready, where it was not yet
  double trace_ms = 0;               // wall clock
  double cpu_ms = 0;                 // of tracing, on all threads together
  std::uint64_t non_finite_pixels = 0;
};

struct RenderResult {
  Image image;
  RenderStats stats;
};

// If the plan leaves the accelerator open: takes the one whose counted work on some tiles of the picture
// costs least, and says so in the plan's decisions. Once for a scene and number type; later plans follow, so
// that frames of one scene do not change it. Returns the milliseconds that took. Throws
// Cancelled if `stop` is requested.
double settle(const PreparedScene& scene, Plan& plan, std::stop_token stop = {});

// Renders one frame on the pool; a plan that is not settled is settled first. Throws Cancelled if
// control.stop is requested. The picture depends on scene and plan alone: not on threads, their order or the
// machine's vector width.
RenderResult render_frame(const PreparedScene& scene, const Plan& plan, PixelFormat format, WorkerPool& pool,
                          const RenderControl& control = {});

}  // namespace orrery
