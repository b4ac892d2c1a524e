#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/params/document.h"
#include "core/render/budget.h"
#include "server/app/streams.h"
#include "server/cache/asset_store.h"
#include "server/cache/pictures.h"
#include "server/cache/scene_store.h"
#include "server/config/settings.h"
#include "server/http/message.h"
#include "server/jobs/jobs.h"
#include "server/rendering/orbit_registry.h"
#include "server/rendering/refinement.h"
#include "server/rendering/render_services.h"
#include "server/scheduler/admission.h"
#include "server/scheduler/work_memory.h"
#include "server/security/access.h"
#include "server/telemetry/service_counters.h"

namespace orrery {

// Durations of the steps of a response, in milliseconds.
struct Timing {
  double load = 0, plan = 0, queue = 0, build = 0, render = 0, encode = 0;
};

struct Rendered {
  std::shared_ptr<const Picture> picture;
  bool made_now;  // rendered for this request, neither cached nor shared
};

// Client of a request.
struct Caller {
  std::string client;    // client that the work is charged to
  std::stop_token gone;  // stop is requested once no client waits for the result
};

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
  const Pictures& pictures() const { return pictures_; }
  const Films& films() const { return films_; }
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
  void read(Body& body, const Caller& caller, Timing& timing, const ReadDocument& work);
  AssetStore::AddResult add_asset(const std::string& sha256, Body& body, const Caller& caller);

  // Returns the image of the plan: cached, or rendered and encoded once for all requests that wait for it.
  // `key` identifies the image regardless of its format. An image with a time budget is rendered for each
  // request, and the steps in `timing` count towards the budget. Throws BudgetMissed and the errors of
  // read(). Throws TooManyRays if the image is not cached and its estimated cost exceeds the limit of one
  // request.
  Rendered render(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
                  const Caller& caller, Timing& timing);

  // Returns a progressive render, which the caller advances pass by pass. Throws Busy while draining. Throws
  // TooManyRays if the image is not cached and its estimated cost exceeds the limit of one request.
  // Refinement::next() throws the other errors.
  std::unique_ptr<Refinement> refine(RefinementSpec spec);

  // Throws TooManyRays if the estimated cost of the image exceeds the limit of one request.
  void require_request_rays(const Scene& scene, const Plan& plan);

  // Settles the plan as render() would. Waits for a slot if accelerators must be tried. Throws the errors of
  // render().
  SettledPlan settle(const PreparedScene& scene, const Plan& plan, const Caller& caller);

  // Predicts the cost and the error of render() from pilots, which wait for a slot. Throws the errors of
  // render().
  Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, const Caller& caller);

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
  void require_open() const;

 private:
  // Calls work(stop) and charges its memory to the caller. Requests `stop` once the client disconnects, the
  // service ends, or request_seconds have passed since `since`. `stage`: current step of the work.
  template <class Work>
  void watched(const Caller& caller, Clock::time_point since, const Stage& stage, const Work& work);
  // Waits for a slot. Throws LimitExceeded if no slot becomes free within `seconds` (0: no limit). `used_s`
  // of them had passed before `since`.
  Admission::Ticket enter_in_time(const SlotRequest& demand, Clock::time_point since, double seconds,
                                  double used_s, const std::stop_token& ends);
  // Returns the maximum rays and seconds that one request may use to meet its budget.
  RenderControl limits_of(const Scene& scene, const Plan& plan) const;
  // Renders the image, unless its film is cached, and encodes it. `since`: start of the client's wait.
  Picture make(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
               const SlotRequest& demand, Clock::time_point since, const std::stop_token& stop,
               Timing& timing, Stage& stage);

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
  SubscribersByKey subscribers_;  // by image, regardless of its format
  Pictures pictures_;
  Films films_;
  Admission admission_;
  RayEstimator estimator_;
  const RenderServices services_;
  Streams streams_;
  OrbitRegistry orbits_;
  Jobs jobs_;
};

}  // namespace orrery
