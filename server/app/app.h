#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/budget/budget.h"
#include "core/params/document.h"
#include "server/app/streams.h"
#include "server/cache/asset_store.h"
#include "server/cache/pictures.h"
#include "server/cache/scene_store.h"
#include "server/config/settings.h"
#include "server/http/message.h"
#include "server/jobs/jobs.h"
#include "server/rendering/orbit_registry.h"
#include "server/rendering/refinement.h"
#include "server/rendering/render_service.h"
#include "server/scheduler/admission.h"
#include "server/scheduler/work_memory.h"
#include "server/scheduler/worker_pool.h"
#include "server/security/access.h"
#include "server/telemetry/service_counters.h"

namespace orrery {

// Service behind the routes. Owns the stores, caches, queues and threads. Thread-safe.
class App {
 public:
  // Throws InputError if a file named in the settings is invalid. `timer` must outlive the app.
  App(const Settings& settings, Timer& timer);
  App(const App&) = delete;

  const Settings& settings() const { return settings_; }
  const Timer& timer() const { return timer_; }
  Access& access() { return access_; }
  SceneStore& scenes() { return scenes_; }
  AssetStore& assets() { return assets_; }
  Streams& streams() { return streams_; }
  OrbitRegistry& orbits() { return orbits_; }
  Jobs& jobs() { return jobs_; }
  RenderService& renders() { return renders_; }
  const Admission& admission() const { return admission_; }
  const WorkMemory& memory() const { return memory_; }
  ServiceCounters& meters() { return meters_; }

  // The only functions that read request bodies. Both charge memory to the client, wait for a slot if the
  // work is long, and stop once the client disconnects. Both throw ClientLimitExceeded, Busy, Cancelled and
  // TimedOut.
  //
  // Parses a JSON body and calls `work` to read the document, which may refer to assets. Also throws the
  // errors of parsing and of `work`.
  using ReadDocument = std::function<void(const Document&, const AssetSource&)>;
  void read(Body& body, const Caller& caller, RequestTrace& trace, const ReadDocument& work);
  // Calls `work` to read assets, under the same rules.
  using ReadAssets = std::function<void(const AssetSource&)>;
  void read_assets(const Caller& caller, RequestTrace& trace, const ReadAssets& work);
  // Stores a body as asset. `sha256`: name that its bytes must have, or "" for any.
  AssetStore::AddResult add_asset(const std::string& sha256, Body& body, const Caller& caller);

  // Returns a progressive render, which the caller advances pass by pass. Throws Busy while draining. Throws
  // TooManyRays if the image is not cached and its estimated cost exceeds the limit of one request.
  // Refinement::next() throws the other errors.
  std::unique_ptr<Refinement> refine(RenderOrder order);

  // Settles the plan as RenderService::render() would. Waits for a slot if accelerators must be tried. Throws
  // the errors of render().
  SettledPlan settle(const StoredScene& scene, const Plan& plan, const Caller& caller);

  // Predicts the cost and the error of render() from pilots, which wait for a slot. Throws the errors of
  // render().
  Forecast forecast(const StoredScene& scene, const SettledPlan& plan, const Caller& caller);

  // Returns whether the service is draining: it completes running work and rejects new work.
  bool draining() const { return drains_.stop_requested(); }
  // Returns "ok" if load balancers should send new work, otherwise "draining", "full" or "slow".
  std::string_view readiness() const;
  // Sets a function that returns the readiness of the HTTP server: "full" if it would reject a new
  // connection, else "ok". Call this before other threads use the app.
  void watch_connections(std::function<std::string_view()> readiness) { connections_ = std::move(readiness); }
  void retire() { retires_ = true; }  // reports "draining" but still accepts new work
  // Starts draining: routes reject new work with Busy, jobs stop, and streams end at their next frame.
  // Running renders complete, but drain() does not wait for them. Cannot be undone.
  void drain();
  // Cancels all running work.
  void end() { ends_.request_stop(); }

  // Throws Busy while draining.
  void require_open() const { services_.require_open(); }

 private:
  // Calls `work` for a body of `bytes`.
  void read_with(std::size_t bytes, const Caller& caller, RequestTrace& trace, const ReadAssets& work);

  Timer& timer_;
  std::function<std::string_view()> connections_ = [] { return std::string_view("ok"); };
  std::atomic<bool> retires_{false};
  std::stop_source drains_, ends_;
  ServiceCounters meters_;
  Access access_;
  WorkerPool pool_;
  const Settings settings_;  // with automatic values resolved
  WorkMemory memory_;
  SceneStore scenes_;
  AssetStore assets_;
  Admission admission_;
  RayEstimator estimator_;
  const RenderServices services_;
  RenderService renders_;
  Streams streams_;
  OrbitRegistry orbits_;
  Jobs jobs_;
};

}  // namespace orrery
