#include "server/app/app.h"

#include "server/cache/asset_reader.h"

namespace orrery {

namespace {

// Rays per second and thread. The sample scenes reach 15 to 80 million.
constexpr double kRaysAThreadSecond = 50e6;

Settings decided(Settings settings, const WorkerPool& pool) {
  settings.threads = pool.threads();
  if (settings.max_concurrent_renders == 0) settings.max_concurrent_renders = 2 * pool.threads();
  if (settings.request_rays == 0)
    settings.request_rays =
        kRaysAThreadSecond * pool.threads() * static_cast<double>(settings.request_seconds.count());
  return settings;
}

}  // namespace

App::App(const Settings& settings, Timer& timer)
    : timer_(timer),
      access_(settings.tokens_file, settings.link_signing_key_file),
      pool_(settings.threads),
      settings_(decided(settings, pool_)),
      memory_(work_bytes(settings)),
      scenes_(settings.scene_cache_bytes, memory_),
      assets_(settings.asset_store_bytes),
      admission_({settings_.max_concurrent_renders, settings_.max_queued_rays}, timer),
      services_{
          pool_,      admission_, timer,   drains_.get_token(),        ends_.get_token(),        meters_,
          estimator_, memory_,    scenes_, settings_.interactive_rays, settings_.request_seconds},
      renders_(services_, settings.image_cache_bytes, settings.film_cache_bytes, settings_.request_rays),
      streams_(settings_.connections),
      orbits_(services_, settings.max_orbit_streams),
      jobs_(services_, {settings.jobs, settings.max_finished_jobs, settings.job_bytes, settings.job_seconds,
                        settings.job_kept_seconds}) {}

void App::read(Body& body, const Caller& caller, RequestTrace& trace, const ReadDocument& work) {
  const std::string bytes = std::move(body.bytes_);
  read_with(bytes.size(), caller, trace,
            [&](const AssetSource& assets) { work(parse_document(bytes), assets); });
}

void App::read_assets(const Caller& caller, RequestTrace& trace, const ReadAssets& work) {
  read_with(0, caller, trace, work);
}

void App::read_with(std::size_t bytes, const Caller& caller, RequestTrace& trace, const ReadAssets& work) {
  services_.run(caller, timer_.now(), trace, [&](const std::stop_token& stop) {
    const auto start = Clock::now();
    const AssetReader reading(assets_, admission_, caller.client, bytes, stop);
    work(reading);
    trace.timing.queue += reading.waited_ms();
    trace.timing.load += milliseconds_since(start) - reading.waited_ms();
  });
}

AssetStore::AddResult App::add_asset(const std::string& sha256, Body& body, const Caller& caller) {
  std::string bytes = std::move(body.bytes_);
  return services_.run(caller, timer_.now(), {}, [&](const std::stop_token& stop) {
    const auto ticket =
        admission_.enter({Priority::interactive, caller.client, cost_of_reading(bytes.size())}, stop);
    return assets_.add(sha256, std::move(bytes), caller.client);
  });
}

std::unique_ptr<Refinement> App::refine(RenderOrder order) {
  require_open();
  auto refinement = std::make_unique<Refinement>(std::move(order), services_, renders_.pictures());
  if (!refinement->is_known()) renders_.require_request_rays(refinement->scene(), refinement->plan());
  return refinement;
}

SettledPlan App::settle(const StoredScene& scene, const Plan& plan, const Caller& caller) {
  if (!plan.try_accelerators) return orrery::settle(scene, plan);
  return services_.run(caller, timer_.now(), {.stage = Stage::settle}, [&](const std::stop_token& stop) {
    const auto ticket = admission_.enter({Priority::interactive, caller.client, kFixedCost}, stop);
    const SceneStore::SizeGuard measured(scenes_, scene);
    return orrery::settle(scene, plan, stop);
  });
}

Forecast App::forecast(const StoredScene& scene, const SettledPlan& plan, const Caller& caller) {
  renders_.require_request_rays(scene.scene(), *plan);
  Plan pilots = *plan;  // cost of the pilots: about 1 sample per pixel, more for small images
  pilots.samples = 1;
  pilots.free_samples = false;
  return services_.run(caller, timer_.now(), {.stage = Stage::settle}, [&](const std::stop_token& stop) {
    auto ticket = admission_.enter(services_.demand_of(scene.scene(), pilots, caller), stop);
    const SceneStore::SizeGuard measured(scenes_, scene);
    RenderControl control = renders_.limits_of(scene.scene(), *plan);
    control.stop = stop;
    PoolExecutor executor(pool_, false, &ticket);
    return orrery::forecast(scene, plan, executor, control);
  });
}

void App::drain() { drains_.request_stop(); }

std::string_view App::readiness() const {
  constexpr std::chrono::seconds kLongWait{5};
  if (retires_ || draining()) return "draining";
  if (admission_.full()) return "full";
  if (const auto state = connections_(); state != "ok") return state;
  return admission_.shortest_client_wait() >= kLongWait ? "slow" : "ok";
}

}  // namespace orrery
