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
#include "server/app/meters.h"
#include "server/app/orbit_hub.h"
#include "server/app/pictures.h"
#include "server/app/refinement.h"
#include "server/app/render_services.h"
#include "server/app/scene_store.h"
#include "server/app/settings.h"
#include "server/app/streams.h"
#include "server/app/work_memory.h"
#include "server/http/message.h"

namespace orrery {

// Milliseconds that the steps of an answer took.
struct Timing {
  double load = 0, plan = 0, queue = 0, build = 0, render = 0, encode = 0;
};

struct Rendered {
  std::shared_ptr<const Picture> picture;
  bool made_now;  // rendered for this request, and not for another one before
};

// Who asks for something.
struct Caller {
  std::string client;    // whose share of the work it is
  std::stop_token gone;  // requested once nobody waits for it any more
};

// All that the service owns, and what its routes ask of it. Safe from any thread.
class App {
 public:
  // Throws InputError for files of the settings that cannot be used.
  // `timer` must outlive it.
  App(const Settings& settings, Timer& timer);
  App(const App&) = delete;

  const Settings& settings() const { return settings_; }
  const Timer& timer() const { return timer_; }
  Access& access() { return access_; }
  SceneStore& scenes() { return scenes_; }
  AssetStore& assets() { return assets_; }
  Streams& streams() { return streams_; }
  OrbitHub& orbits() { return orbits_; }
  Jobs& jobs() { return jobs_; }
  const Pictures& pictures() const { return pictures_; }
  const Films& films() const { return films_; }
  const Admission& admission() const { return admission_; }
  const WorkMemory& memory() const { return memory_; }
  Meters& meters() { return meters_; }

  // The one door for bodies of requests. Both take the body, count the memory of the work in the client's
  // account, wait for a turn if it takes long, and stop once the client has gone. Both throw ClientBusy,
  // Busy, Cancelled and TimedOut.
  //
  // Parses a body of JSON and calls `work` to read it; it may name assets. Throws what both do.
  using ReadDocument = std::function<void(const Document&, const AssetSource&)>;
  void read(Body& body, const Caller& caller, Timing& timing, const ReadDocument& work);
  AssetStore::Added add_asset(const std::string& sha256, Body& body, const Caller& caller);

  // The picture of that plan, which `key` names whatever its format: one made before, or rendered and encoded
  // in its turn, once for all who ask; one with a budget of time, which counts from now, for each. Throws as
  // read(), BudgetMissed, and TooManyRays instead of rendering it.
  Rendered render(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
                  const Caller& caller, Timing& timing);

  // Passes of a picture, to be asked for one by one. Throws Busy while draining, TooManyRays.
  std::unique_ptr<Refinement> refine(RefinementSpec spec);

  // Throws TooManyRays for a picture that is expected to take more than one request may ask for.
  void require_request_rays(const Scene& scene, const Plan& plan);

  // Settles the plan in its turn, as render() would. Throws likewise.
  SettledPlan settle(const PreparedScene& scene, const Plan& plan, const Caller& caller);

  // Foretells what render() would take, in its turn. Throws likewise.
  Forecast forecast(const PreparedScene& scene, const SettledPlan& plan, const Caller& caller);

  // The service is about to end: no new work; what runs goes on.
  bool draining() const { return drains_.stop_requested(); }
  // Whether new work should be sent here: "ok", or why not: "draining", "full" or "slow".
  std::string_view readiness() const;
  // `readiness`: of the HTTP server, "full" where a new client would get no connection, else "ok". Called
  // before others use the app.
  void watch_connections(std::function<std::string_view()> readiness) { connections_ = std::move(readiness); }
  void retire() { retires_ = true; }  // new work is still taken, but should go elsewhere
  void drain();
  // What still runs ends now.
  void end() { ends_.request_stop(); }

  // Throws Busy while draining.
  void require_open() const;

 private:
  // Calls work(stop), which is stopped when it should end early and tells `stage` what it is at; its time
  // counts from `since`. It takes memory of the caller's share.
  template <class Work>
  void watched(const Caller& caller, Clock::time_point since, const Stage& stage, const Work& work);
  // A turn; throws OverLimit once it cannot come within so many seconds, of which some were used before
  // `since`. 0: whenever it comes.
  Admission::Ticket enter_in_time(const Demand& demand, Clock::time_point since, double seconds,
                                  double used_s, const std::stop_token& ends);
  // What a budget of one request may spend.
  RenderControl limits_of(const Scene& scene, const Plan& plan) const;
  // Renders it, unless a film of it is kept, and encodes it. The client has waited since `since`.
  Picture make(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
               const Demand& demand, Clock::time_point since, const std::stop_token& stop, Timing& timing,
               Stage& stage);

  Timer& timer_;
  std::function<std::string_view()> connections_ = [] { return std::string_view("ok"); };
  std::atomic<bool> retires_{false};
  std::stop_source drains_, ends_;
  Meters meters_;
  Access access_;
  WorkerPool pool_;
  const Settings settings_;  // with what is left to the machine decided
  WorkMemory memory_;
  SceneStore scenes_;
  AssetStore assets_;
  SharersByKey sharers_;  // of pictures, whatever their format
  Pictures pictures_;
  Films films_;
  Admission admission_;
  RayEstimator estimator_;
  const RenderServices services_;
  Streams streams_;
  OrbitHub orbits_;
  Jobs jobs_;
};

}  // namespace orrery
