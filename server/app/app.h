#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/params/document.h"
#include "core/render/budget.h"
#include "server/app/access.h"
#include "server/app/admission.h"
#include "server/app/asset_store.h"
#include "server/app/jobs.h"
#include "server/app/orbit_registry.h"
#include "server/app/pictures.h"
#include "server/app/refinement.h"
#include "server/app/render_services.h"
#include "server/app/scene_store.h"
#include "server/app/service_counters.h"
#include "server/app/settings.h"
#include "server/app/streams.h"
#include "server/app/work_memory.h"
#include "server/http/message.h"

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

// Owner of the stores, caches, queues and threads of the service, and its interface to the routes. Safe from
// any thread.
class App {
 public:
  // Throws InputError if a file in the settings cannot be used. `timer` must outlive the app.
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

  // The only functions that take request bodies. Both charge memory to the client, wait for a slot if the
  // work is long, and stop once the client disconnects. Both throw ClientLimitExceeded, Busy, Cancelled and
  // TimedOut.
  //
  // Parses a JSON body and calls `work` to read the document, which may name assets. Also throws the errors
  // of both.
  using ReadDocument = std::function<void(const Document&, const AssetSource&)>;
  void read(Body& body, const Caller& caller, Timing& timing, const ReadDocument& work);
  AssetStore::AddResult add_asset(const std::string& sha256, Body& body, const Caller& caller);

  // Returns the image of the plan: cached, or rendered and encoded once for all requests that wait for it.
  // `key` names the image in any format. An image with a time budget is rendered for each request, and the
  // steps in `timing` count towards the budget. Throws as read(), BudgetMissed, and TooManyRays instead of
  // rendering.
  Rendered render(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
                  const Caller& caller, Timing& timing);

  // Returns a progressive render, which the caller advances pass by pass. Throws Busy while draining, and
  // TooManyRays unless the image is cached. Refinement::next() throws the other errors.
  std::unique_ptr<Refinement> refine(RefinementSpec spec);

  // Throws TooManyRays if the estimated cost of the image exceeds the limit of one request.
  void require_request_rays(const Scene& scene, const Plan& plan);

  // Settles the plan in a slot, as render() would. Throws as render() does.
  SettledPlan settle(const PreparedScene& scene, const Plan& plan, const Caller& caller);

  // Predicts the cost and the error of render(), in a slot. Throws as render() does.
  Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, const Caller& caller);

  // Returns whether the service is draining: it completes running work and rejects new work.
  bool draining() const { return drains_.stop_requested(); }
  // Returns "ok" if new work should be sent here, else the reason: "draining", "full" or "slow".
  std::string_view readiness() const;
  // Sets the readiness of the HTTP server: "full" if it would reject a new connection, else "ok". Call this
  // before other threads use the app.
  void watch_connections(std::function<std::string_view()> readiness) { connections_ = std::move(readiness); }
  void retire() { retires_ = true; }  // reports "draining" but still accepts work
  // Starts draining: routes reject new work with Busy, jobs stop, and streams end at their next frame.
  // Running renders complete. Does not wait for them. Cannot be undone.
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
  // Waits for a slot. Throws LimitExceeded if there is none within `seconds`, of which `used_s` had passed
  // before `since`. 0: no time limit.
  Admission::Ticket enter_in_time(const SlotRequest& demand, Clock::time_point since, double seconds,
                                  double used_s, const std::stop_token& ends);
  // Returns the limits for the budget of one request.
  RenderControl limits_of(const Scene& scene, const Plan& plan) const;
  // Renders the image, unless its film is cached, and encodes it. The client has waited since `since`.
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
  SubscribersByKey subscribers_;  // by image, in any format
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
