#include "server/app/app.h"

#include <algorithm>
#include <optional>

#include "core/base/shorten.h"
#include "core/plan/cost.h"
#include "core/plan/warnings.h"
#include "core/render/views.h"
#include "server/cache/asset_reader.h"
#include "server/scheduler/watch.h"

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

// Throws InputError if the film with the plan's layers needs more than half of `work_bytes`.
void require_layers_fit(const Plan& plan, std::size_t work_bytes) {
  const std::size_t bytes = Film::bytes(plan.width, plan.height, FilmStorage::sums, plan.channels);
  if (bytes <= work_bytes / 2) return;
  throw InputError("/render/layers", "layers need " + grouped(bytes) + " bytes at " +
                                         std::to_string(plan.width) + " x " + std::to_string(plan.height) +
                                         " pixels (limit " + grouped(work_bytes / 2) +
                                         ", half of work_bytes)");
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
      pictures_(settings.image_cache_bytes),
      films_(settings.film_cache_bytes, settings.film_cache_bytes / 4),
      admission_({settings_.max_concurrent_renders, settings_.max_queued_rays}, timer),
      services_{pool_,      admission_, timer,   drains_.get_token(),       ends_.get_token(), meters_,
                estimator_, memory_,    scenes_, settings_.interactive_rays},
      streams_(settings_.connections),
      orbits_(services_, settings.max_orbit_streams, settings.request_seconds),
      jobs_(services_, {settings.jobs, settings.max_finished_jobs, settings.job_bytes, settings.job_seconds,
                        settings.job_kept_seconds}) {}

template <class Work>
void App::watched(const Caller& caller, Clock::time_point since, const Stage& stage, const Work& work) {
  require_open();
  const WorkCancellation watch(caller.gone, ends_.get_token(), timer_, since,
                               {settings_.request_seconds, "request_seconds"});
  const auto memory = memory_.open(caller.client);
  const std::stop_token stop = watch.stop();
  try {
    memory->run(stop, [&] { work(stop); });
  } catch (const Cancelled&) {
    ++meters_.cancelled[static_cast<std::size_t>(stage)];
    watch.explain();
  }
}

void App::read(Body& body, const Caller& caller, Timing& timing, const ReadDocument& work) {
  const std::string bytes = std::move(body.bytes_);
  watched(caller, timer_.now(), Stage::read, [&](const std::stop_token& stop) {
    const auto start = Clock::now();
    const AssetReader reading(assets_, admission_, caller.client, bytes.size(), stop);
    work(parse_document(bytes), reading);
    timing.queue += reading.waited_ms();
    timing.load += milliseconds_since(start) - reading.waited_ms();
  });
}

AssetStore::AddResult App::add_asset(const std::string& sha256, Body& body, const Caller& caller) {
  std::string bytes = std::move(body.bytes_);
  AssetStore::AddResult added;
  watched(caller, timer_.now(), Stage::read, [&](const std::stop_token& stop) {
    const auto ticket =
        admission_.enter({Priority::interactive, caller.client, cost_of_reading(bytes.size())}, stop);
    added = assets_.add(sha256, std::move(bytes), caller.client);
  });
  return added;
}

Rendered App::render(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
                     const Caller& caller, Timing& timing) {
  SlotRequest demand = services_.demand_of(scene.scene(), plan, caller.client);
  demand.subscribers = subscribers_.of(key);
  const auto start = Clock::now();
  const auto since = timer_.now();
  const auto make_picture = [&](const std::stop_token& nobody_waits) {
    require_request_rays(scene.scene(), plan);
    Picture picture;
    Stage stage = Stage::queue;
    watched({caller.client, nobody_waits}, since, stage, [&](const std::stop_token& stop) {
      picture = make(scene, plan, key, format, demand, since, stop, timing, stage);
    });
    return picture;
  };
  if (*plan.asked.seconds > 0) {
    const auto picture = std::make_shared<const Picture>(make_picture(caller.gone));
    ++meters_.pictures_made;
    return {picture, true};
  }
  const Pictures::LookupResult found = pictures_.get(
      picture_key(key, format), {caller.gone, caller.client, demand.subscribers, &admission_}, make_picture);
  ++(found.made_here ? meters_.pictures_made : meters_.pictures_found);
  if (!found.made_here) timing.queue += milliseconds_since(start);
  return {found.value, found.made_here && !found.value->from_cached_film};
}

Admission::Ticket App::enter_in_time(const SlotRequest& demand, Clock::time_point since, double seconds,
                                     double used_s, const std::stop_token& ends) {
  if (seconds == 0) return admission_.enter(demand, ends);
  std::stop_source late;
  const std::stop_callback forward(ends, [&] { late.request_stop(); });
  const auto alarm = timer_.at(
      since + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds - used_s)),
      [&] { late.request_stop(); });
  try {
    Admission::Ticket ticket = admission_.enter(demand, late.get_token());
    ticket.set_stop(ends);
    return ticket;
  } catch (const Cancelled&) {
    if (ends.stop_requested()) throw;
    throw LimitExceeded(
        "no slot became free in time (limit " + number_text(seconds) + " s, time_limit_seconds)",
        limited_retry_s(seconds), "max_concurrent_renders");
  }
}

RenderControl App::limits_of(const Scene& scene, const Plan& plan) const {
  return {.max_rays = settings_.request_rays / ray_weight(scene, plan),
          .max_s = kShareOfBudgets * static_cast<double>(settings_.request_seconds.count())};
}

Picture App::make(const PreparedScene& scene, const Plan& plan, const std::string& key, FileFormat format,
                  const SlotRequest& demand, Clock::time_point since, const std::stop_token& stop,
                  Timing& timing, Stage& stage) {
  std::optional<Admission::Ticket> ticket;
  const double before_s = (timing.load + timing.plan + timing.queue) / 1000;
  const auto enter = [&](const SlotRequest& asked, const std::stop_token& ends) {
    const auto start = Clock::now();
    ticket.emplace(enter_in_time(asked, since, *plan.asked.seconds, before_s, ends));
    timing.queue += milliseconds_since(start);
  };
  const FilmStorage storage = shared_storage(format, plan, films_.largest());
  if (storage == FilmStorage::sums) require_layers_fit(plan, memory_.most());
  RenderControl control = limits_of(scene.scene(), plan);
  control.background = demand.priority == Priority::batch;
  control.used_s = [this, since, before_s] {
    return before_s + std::chrono::duration<double>(timer_.now() - since).count();
  };
  const auto make_film = [&](const std::stop_token& nobody_waits) {
    enter(demand, nobody_waits);
    stage = Stage::render;
    RenderControl stopped = control;
    stopped.stop = nobody_waits;
    return TaskScope::current().memory->run(
        nobody_waits, [&] { return services_.render(*ticket, scene, plan, storage, stopped); });
  };
  const Films::LookupResult film =
      *plan.asked.seconds > 0
          ? Films::LookupResult{std::make_shared<const RenderResult>(make_film(stop)), true}
          : films_.get(key + std::to_string(static_cast<int>(storage)), {stop, demand.client}, make_film);
  const RenderStats& stats = film.value->stats;
  ++(film.made_here ? meters_.films_made : meters_.films_found);
  if (film.made_here) {
    timing.build = stats.build_ms;
    timing.render = stats.trace_ms;
  } else {
    enter({Priority::interactive, demand.client, kFixedCost, demand.subscribers}, stop);
  }
  Picture picture{.bytes = {},
                  .stats = stats,
                  .certificate = film.value->certificate,
                  .warnings = find_warnings(scene.scene(), plan, stats.counts),
                  .budget = film.value->budget,
                  .from_cached_film = !film.made_here};
  stage = Stage::encode;
  const auto start = Clock::now();
  picture.bytes = encode_film(film.value->film, format);
  picture.bytes.shrink_to_fit();  // the bytes may be cached
  timing.encode = milliseconds_since(start);
  if (picture.budget) {
    picture.budget->end_at(control.used_s());
    require_met(*picture.budget, picture.certificate);
  }
  return picture;
}

std::unique_ptr<Refinement> App::refine(RefinementSpec spec) {
  require_open();
  auto refinement =
      std::make_unique<Refinement>(std::move(spec), services_, pictures_, settings_.request_seconds);
  if (!refinement->is_known()) require_request_rays(refinement->scene(), refinement->plan());
  return refinement;
}

void App::require_request_rays(const Scene& scene, const Plan& plan) {
  // Uses the smaller estimate, so that renders of other clients cannot cause a rejection.
  const double rays =
      ray_weight(scene, plan) * std::min(estimator_.estimate(scene, plan), expected_rays(scene, plan));
  if (rays > settings_.request_rays) throw TooManyRays(rays, settings_.request_rays);
}

SettledPlan App::settle(const PreparedScene& scene, const Plan& plan, const Caller& caller) {
  if (!plan.try_accelerators) return orrery::settle(scene, plan);
  std::optional<SettledPlan> settled;
  watched(caller, timer_.now(), Stage::settle, [&](const std::stop_token& stop) {
    const auto ticket = admission_.enter({Priority::interactive, caller.client, kFixedCost}, stop);
    const SceneStore::SizeGuard measured(scenes_, scene);
    settled = orrery::settle(scene, plan, stop);
  });
  return *settled;
}

Forecast App::forecast(const PreparedScene& scene, const SettledPlan& plan, const Caller& caller) {
  require_request_rays(scene.scene(), *plan);
  Plan pilots = *plan;  // cost of the pilots: about 1 sample per pixel, more for small images
  pilots.samples = 1;
  pilots.free_samples = false;
  std::optional<Forecast> found;
  watched(caller, timer_.now(), Stage::settle, [&](const std::stop_token& stop) {
    auto ticket = admission_.enter(services_.demand_of(scene.scene(), pilots, caller.client), stop);
    const SceneStore::SizeGuard measured(scenes_, scene);
    RenderControl control = limits_of(scene.scene(), *plan);
    control.stop = stop;
    control.lease = &ticket;
    found = orrery::forecast(scene, plan, pool_, control);
  });
  return *found;
}

void App::drain() { drains_.request_stop(); }

std::string_view App::readiness() const {
  constexpr std::chrono::seconds kLongWait{5};
  if (retires_ || draining()) return "draining";
  if (admission_.full()) return "full";
  if (const auto state = connections_(); state != "ok") return state;
  return admission_.shortest_client_wait() >= kLongWait ? "slow" : "ok";
}

void App::require_open() const {
  if (draining()) throw Busy("service is shutting down", 5);
}

}  // namespace orrery
