#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stop_token>

#include "core/budget/renderer.h"
#include "core/plan/cost.h"
#include "server/cache/scene_store.h"
#include "server/scheduler/admission.h"
#include "server/scheduler/ray_estimator.h"
#include "server/scheduler/worker_pool.h"
#include "server/telemetry/service_counters.h"

namespace orrery {

// Fraction of the time limit that a budget may use. The remainder is for encoding and returning the best
// image.
inline constexpr double kShareOfBudgets = 0.9;

// Services that all renders share. They must outlive every render that uses them.
struct RenderServices {
  WorkerPool& pool;
  Admission& admission;
  Timer& timer;
  std::stop_token draining;  // no new work; streams end at the next frame
  std::stop_token ends;      // cancels all work
  ServiceCounters& meters;
  RayEstimator& estimator;
  WorkMemory& memory;
  SceneStore& scenes;
  double interactive_rays;               // maximum cost of a frame with interactive priority, in usual rays
  std::chrono::seconds request_seconds;  // time limit of one request

  // Throws Busy while draining.
  void require_open() const {
    if (draining.stop_requested()) throw Busy("service is shutting down", 5);
  }

  // Returns the slot request for a frame. Its cost is the estimate in usual rays plus kFixedCost. The frame
  // is batch work if either the plan alone or the learned estimate exceeds interactive_rays.
  SlotRequest demand_of(const Scene& scene, const Plan& plan, const std::string& client) const {
    const double rays = estimator.estimate(scene, plan), weight = ray_weight(scene, plan);
    const bool small = weight * std::max(rays, expected_rays(scene, plan)) <= interactive_rays;
    return {small ? Priority::interactive : Priority::batch, client, kFixedCost + weight * rays};
  }

  // Returns render(). If render() throws LimitExceeded because other work holds the memory, waits and calls
  // it again. Throws the other errors of render(), and Cancelled once `stop` is requested.
  template <class Render>
  RenderResult retry_while_out_of_memory(const std::stop_token& stop, const Render& render) const {
    for (;;) try {
        return render();
      } catch (const LimitExceeded& busy) {
        pause(busy.retry_after_s(), stop);
      }
  }

  // Renders a frame in the slot of `ticket`. Frames of interactive priority have precedence on the threads.
  // Reports the measured cost to the ticket and the size of the scene to the store. Throws the errors of
  // render_frame().
  RenderResult render(Admission::Ticket& ticket, Priority priority, const StoredScene& scene,
                      const Plan& plan, FilmStorage storage, const RenderControl& control) const {
    PoolExecutor executor(pool, priority == Priority::batch, &ticket);
    const SceneStore::SizeGuard measured(scenes, scene);
    const SettledPlan settled = settle(scene, plan, control.stop);
    RenderResult result = render_frame(scene, settled, storage, executor, control);
    Plan done = *settled;
    if (result.budget) done.samples = *result.budget->settings.samples;
    done.free_samples = false;
    count(ticket, scene.scene(), done, result.stats.counts.rays.total(),
          result.stats.build_ms + result.stats.trace_ms);
    return result;
  }

  // Records the measured cost of the plan's samples in the ticket, the estimator and the metrics.
  void count(Admission::Ticket& ticket, const Scene& scene, const Plan& plan, std::uint64_t rays,
             double ms) const {
    ticket.set_cost(kFixedCost + ray_weight(scene, plan) * static_cast<double>(rays));
    estimator.learn(scene, plan, rays);
    meters.rays += rays;
    meters.render.Observe(ms / 1000);
  }

 private:
  // Waits for `seconds`. Throws Cancelled once `stop` is requested.
  void pause(double seconds, const std::stop_token& stop) const {
    std::mutex mutex;
    std::condition_variable_any nothing;
    std::unique_lock lock(mutex);
    const auto until =
        timer.now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    wait_until(timer, nothing, lock, stop, until, [] { return false; });
    if (stop.stop_requested()) throw Cancelled();
  }
};

}  // namespace orrery
