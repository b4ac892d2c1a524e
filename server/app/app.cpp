#include "server/app/app.h"

#include "core/load/load.h"
#include "server/app/watch.h"

namespace orrery {

App::App(const Settings& settings)
    : settings_(settings),
      pool_(settings.threads),
      scenes_(settings.store_bytes),
      assets_(settings.asset_store_bytes),
      admission_(settings.renders > 0 ? settings.renders : 2 * pool_.threads(), settings.queue),
      orbits_({pool_, admission_, draining_, ends_, settings.request_time}, settings.orbits) {}

std::shared_ptr<const Scene> App::load(const Document& document, Timing& timing) const {
  const auto start = Clock::now();
  auto scene = load_scene(document, assets_);
  timing.load += milliseconds_since(start);
  return scene;
}

Picture App::render(const PreparedScene& scene, const Plan& plan, FileFormat format,
                    std::function<bool()> gone, Timing& timing) {
  Picture picture;
  in_turn(std::move(gone), timing.queue, [&](const auto& stop) {
    RenderResult rendered =
        render_frame(scene, plan, pixels_of(format), pool_, {.stop = stop, .progress = {}});
    timing.build = rendered.stats.build_ms;
    timing.render = rendered.stats.trace_ms;
    const auto start = Clock::now();
    picture = {encode(rendered.image, format), rendered.stats};
    timing.encode = milliseconds_since(start);
  });
  return picture;
}

void App::settle(const PreparedScene& scene, Plan& plan, std::function<bool()> gone) {
  if (!plan.try_accelerators) return;
  double queue_ms = 0;
  in_turn(std::move(gone), queue_ms, [&](const auto& stop) { orrery::settle(scene, plan, stop); });
}

template <class Work>
void App::in_turn(std::function<bool()> gone, double& queue_ms, const Work& work) {
  require_open();
  const Watch watch(std::move(gone), ends_, settings_.request_time);
  const auto stop = [&] { return watch.stop(); };
  try {
    const auto start = Clock::now();
    const auto ticket = admission_.enter(stop);
    queue_ms = milliseconds_since(start);
    work(stop);
  } catch (const Cancelled&) {
    watch.explain();
  }
}

void App::drain() {
  draining_ = true;
  orbits_.wake();
}

std::string_view App::readiness() const {
  if (draining_) return "draining";
  return admission_.full() ? "full" : "ok";
}

void App::require_open() const {
  if (draining_) throw Busy("The service is about to end and takes no new work", 5);
}

}  // namespace orrery
