#pragma once

#include <algorithm>
#include <atomic>
#include <stop_token>

#include "core/plan/cost.h"
#include "core/render/renderer.h"
#include "server/app/admission.h"
#include "server/app/meters.h"
#include "server/app/ray_estimator.h"
#include "server/app/scene_store.h"

namespace orrery {

// Of the time that work may take: what budgets may, so that the best that was made is told.
inline constexpr double kShareOfBudgets = 0.9;

// Services that all renders share. They must outlive every render that uses them.
struct RenderServices {
  WorkerPool& pool;
  Admission& admission;
  Timer& timer;
  std::stop_token draining;  // no new work; what goes on and on ends at its next frame
  std::stop_token ends;      // all work ends at once
  Meters& meters;
  RayEstimator& estimator;
  WorkMemory& memory;
  SceneStore& scenes;
  double interactive_rays;  // of one frame, beyond which it is batch work

  // What a frame is expected to cost, in usual rays: for those that it traces, and a little for its fixed
  // work. It is batch work if either the plan alone or what was learned says so.
  Demand demand_of(const Scene& scene, const Plan& plan, const std::string& client) const {
    const double rays = estimator.estimate(scene, plan), weight = ray_weight(scene, plan);
    const bool small = weight * std::max(rays, expected_rays(scene, plan)) <= interactive_rays;
    return {small ? Lane::interactive : Lane::batch, client, kLeastCost + weight * rays};
  }

  // What render() returns; where it throws OverLimit, because others have the memory that it needs, it is
  // called again after a while. Throws what else it throws, and Cancelled once `stop` is requested.
  template <class Render>
  RenderResult once_there_is_memory(const std::stop_token& stop, const Render& render) const {
    for (;;) try {
        return render();
      } catch (const OverLimit& busy) {
        pause(busy.retry_after_s(), stop);
      }
  }

  // A frame, in the turn that `ticket` gives; tells it what the frame has cost, and the store what the scene
  // takes. Throws Cancelled.
  RenderResult render(Admission::Ticket& ticket, const PreparedScene& scene, const Plan& plan,
                      FilmStorage storage, const RenderControl& control) const {
    RenderControl shared = control;
    shared.pass = &ticket;
    const SceneStore::Measured measured(scenes, scene);
    const SettledPlan settled = settle(scene, plan, control.stop);
    RenderResult result = render_frame(scene, settled, storage, pool, shared);
    Plan done = *settled;
    if (result.budget) done.samples = *result.budget->settings.samples;
    done.free_samples = false;
    count(ticket, scene.scene(), done, result.stats.counts.rays.total(),
          result.stats.build_ms + result.stats.trace_ms);
    return result;
  }

  // Tells all who want to know it what the samples of that plan have cost.
  void count(Admission::Ticket& ticket, const Scene& scene, const Plan& plan, std::uint64_t rays,
             double ms) const {
    ticket.set_cost(kLeastCost + ray_weight(scene, plan) * static_cast<double>(rays));
    estimator.learn(scene, plan, rays);
    meters.rays += rays;
    meters.render.Observe(ms / 1000);
  }

 private:
  // Throws Cancelled once `stop` is requested.
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
