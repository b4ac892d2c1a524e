#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "core/params/document.h"
#include "server/app/admission.h"
#include "server/app/asset_store.h"
#include "server/app/orbit_hub.h"
#include "server/app/scene_store.h"
#include "server/app/settings.h"

namespace orrery {

// Milliseconds that the steps of an answer took.
struct Timing {
  double load = 0, plan = 0, queue = 0, build = 0, render = 0, encode = 0;
};

// A picture made for one request.
struct Picture {
  std::string bytes;
  RenderStats stats;
};

// All that the service owns, and what its routes ask of it. Safe from any thread.
class App {
 public:
  explicit App(const Settings& settings);
  App(const App&) = delete;

  const Settings& settings() const { return settings_; }
  SceneStore& scenes() { return scenes_; }
  AssetStore& assets() { return assets_; }
  OrbitHub& orbits() { return orbits_; }
  const Admission& admission() const { return admission_; }
  int threads() const { return pool_.threads(); }

  // Parses and checks a scene. Throws InputError.
  std::shared_ptr<const Scene> load(const Document& document, Timing& timing) const;

  // Renders and encodes, in its turn. Ends early once `gone` says that nobody waits for it. Throws Busy,
  // Cancelled, TimedOut.
  Picture render(const PreparedScene& scene, const Plan& plan, FileFormat format, std::function<bool()> gone,
                 Timing& timing);

  // Settles the plan in its turn, as render() would. Throws likewise.
  void settle(const PreparedScene& scene, Plan& plan, std::function<bool()> gone);

  // The service is about to end: no new work; what runs goes on.
  bool draining() const { return draining_; }
  // Whether new work is taken: "ok", or why not: "draining" or "full".
  std::string_view readiness() const;
  void drain();
  // What still runs ends now.
  void end() { ends_ = true; }

  // Throws Busy while draining.
  void require_open() const;

 private:
  // Does work(stop) when its turn comes; `stop` says when it should end early.
  template <class Work>
  void in_turn(std::function<bool()> gone, double& queue_ms, const Work& work);

  const Settings settings_;
  std::atomic<bool> draining_{false}, ends_{false};
  WorkerPool pool_;
  SceneStore scenes_;
  AssetStore assets_;
  Admission admission_;
  OrbitHub orbits_;
};

}  // namespace orrery
