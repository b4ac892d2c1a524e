#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stop_token>

#include "core/budget/renderer.h"
#include "core/plan/cost.h"
#include "core/render/views.h"
#include "server/cache/scene_store.h"
#include "server/rendering/render_order.h"
#include "server/scheduler/admission.h"
#include "server/scheduler/ray_estimator.h"
#include "server/scheduler/watch.h"
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
  SlotRequest demand_of(const Scene& scene, const Plan& plan, const Caller& caller) const {
    const double rays = estimator.estimate(scene, plan), weight = ray_weight(scene, plan);
    const bool small = weight * std::max(rays, expected_rays(scene, plan)) <= interactive_rays;
    return {small ? Priority::interactive : Priority::batch, caller.client, kFixedCost + weight * rays,
            caller.subscribers};
  }

  // Returns work(stop), and charges its memory to `account`. Requests `stop` once the client disconnects, the
  // service ends, or request_seconds have passed since `since`. Counts cancelled work by the stage in
  // `trace`. Throws Busy once the service ends, Cancelled, TimedOut and the errors of `work`.
  template <class Work>
  auto run(const Caller& caller, Clock::time_point since, const RequestTrace& trace, WorkAccount& account,
           const Work& work) const {
    const WorkCancellation watch(caller.gone, ends, timer, since, {request_seconds, "request_seconds"});
    return watch.run([&](const std::stop_token& stop) {
      try {
        return account.run(stop, [&] { return work(stop); });
      } catch (const Cancelled&) {
        ++meters.cancelled[static_cast<std::size_t>(trace.stage)];
        throw;
      }
    });
  }

  // Calls run() with a new account of the caller. Also throws Busy while draining.
  template <class Work>
  auto run(const Caller& caller, Clock::time_point since, const RequestTrace& trace, const Work& work) const {
    require_open();
    return run(caller, since, trace, *memory.open(caller.client), work);
  }

  // Renders an image in the slot of `ticket`. `background`: see WorkerPool::for_each(). Reports the measured
  // cost to the ticket and the size of the scene to the store. Throws the errors of render_frame().
  RenderResult render(Admission::Ticket& ticket, bool background, const RenderOrder& order,
                      FilmStorage storage, const RenderControl& control) const {
    PoolExecutor executor(pool, background, &ticket);
    const SceneStore::SizeGuard measured(scenes, *order.scene);
    const SettledPlan settled = settle(*order.scene, order.plan, control.stop);
    RenderResult result = render_frame(*order.scene, settled, storage, executor, control);
    result.stats.halves = {};  // large, and only the certificate needs them
    Plan done = *settled;
    if (result.budget) done.samples = *result.budget->settings.samples;
    done.free_samples = false;
    count(ticket, order.scene->scene(), done, result.stats.counts.rays.total(),
          result.stats.build_ms + result.stats.trace_ms);
    return result;
  }

  // Renders the next frame of an orbit or a job in a slot of its own, and charges its memory to `account`,
  // the account of the films of all its frames. A full queue does not reject the frame. `background`: batch
  // priority. Calls `begun` when the frame gets its slot. If other work holds the memory, waits and
  // starts again. Throws Cancelled once control.stop is requested, and the errors of render().
  RenderResult render_next(
      const RenderOrder& order, WorkAccount& account, bool background, const RenderControl& control,
      const std::function<void()>& begun = [] {}) const {
    for (;;) try {
        SlotRequest demand = demand_of(order.scene->scene(), order.plan, order.caller);
        if (background) demand.priority = Priority::batch;
        Admission::Ticket ticket = admission.enter_again(demand, control.stop);
        account.settle(0);  // returns the memory granted to earlier frames
        begun();
        return account.run(control.stop, [&] {
          return render(ticket, background, order, storage_for(order.format, order.plan), control);
        });
      } catch (const LimitExceeded& busy) {
        pause(busy.retry_after_s(), control.stop);
      }
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
