#include "server/rendering/render_service.h"

#include <algorithm>
#include <optional>

#include "core/base/shorten.h"
#include "core/params/params.h"
#include "core/plan/cost.h"
#include "core/plan/warnings.h"
#include "core/render/views.h"

namespace orrery {
namespace {

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

// A request on its way through the steps.
struct RenderService::Run {
  const RenderOrder& order;
  RequestTrace& trace;
  const Clock::time_point since;  // start of the client's wait
  SlotRequest demand;
  std::string key;
  double before_s = 0;  // seconds of the request before `since`
  std::optional<Admission::Ticket> ticket = {};

  const Scene& scene() const { return order.scene->scene(); }
  // Returns the seconds that the client has waited, including earlier steps of the request.
  double waited_s(const Timer& timer) const {
    return before_s + std::chrono::duration<double>(timer.now() - since).count();
  }
  double time_limit_s() const { return *order.plan.asked.seconds; }  // 0: no time budget
};

RenderService::RenderService(const RenderServices& services, std::size_t image_cache_bytes,
                             std::size_t film_cache_bytes, double request_rays)
    : services_(services),
      request_rays_(request_rays),
      pictures_(image_cache_bytes),
      films_(film_cache_bytes, film_cache_bytes / 4) {}

Rendered RenderService::render(const RenderOrder& order, RequestTrace& trace) {
  trace.timing.plan += order.plan_ms;
  Run run{.order = order,
          .trace = trace,
          .since = services_.timer.now(),
          .demand = services_.demand_of(order.scene->scene(), order.plan, order.caller),
          .key = order.key()};
  run.demand.subscribers = subscribers_.of(run.key);
  run.before_s = (trace.timing.load + trace.timing.plan + trace.timing.queue) / 1000;
  return look_up(run);
}

Rendered RenderService::look_up(Run& run) {
  const auto start = Clock::now();
  const auto make_image = [&](const std::stop_token& nobody_waits) {
    require_request_rays(run.scene(), run.order.plan);
    run.trace.stage = Stage::queue;
    return services_.run({run.order.caller.client, nobody_waits}, run.since, run.trace,
                         [&](const std::stop_token& stop) { return make(run, stop); });
  };
  if (run.time_limit_s() > 0) {  // how long the client waits decides its pixels
    const auto picture = std::make_shared<const Picture>(make_image(run.order.caller.gone));
    ++services_.meters.pictures_made;
    return {picture, true};
  }
  const Pictures::LookupResult found = pictures_.get(
      picture_key(run.key, run.order.format),
      {run.order.caller.gone, run.order.caller.client, run.demand.subscribers, &services_.admission},
      make_image);
  ++(found.made_here ? services_.meters.pictures_made : services_.meters.pictures_found);
  if (!found.made_here) run.trace.timing.queue += milliseconds_since(start);
  return {found.value, found.made_here && !found.value->from_cached_film};
}

Picture RenderService::make(Run& run, const std::stop_token& stop) {
  const Films::LookupResult film = obtain_film(run, stop);
  if (film.made_here) {
    ++services_.meters.films_made;
    run.trace.timing.build = film.value->stats.build_ms;
    run.trace.timing.render = film.value->stats.trace_ms;
  } else {
    ++services_.meters.films_found;
    run.ticket.emplace(
        queue(run, {Priority::interactive, run.demand.client, kFixedCost, run.demand.subscribers}, stop));
  }
  return encode(run, film);
}

Films::LookupResult RenderService::obtain_film(Run& run, const std::stop_token& stop) {
  const FilmStorage storage = shared_storage(run.order.format, run.order.plan, films_.largest());
  if (storage == FilmStorage::sums) require_layers_fit(run.order.plan, services_.memory.most());
  const auto make_film = [&](const std::stop_token& nobody_waits) {
    return render_film(run, storage, nobody_waits);
  };
  if (run.time_limit_s() > 0) return {std::make_shared<const RenderResult>(make_film(stop)), true};
  return films_.get(run.key + std::to_string(static_cast<int>(storage)), {stop, run.demand.client},
                    make_film);
}

Admission::Ticket RenderService::queue(Run& run, const SlotRequest& demand, const std::stop_token& stop) {
  const auto start = Clock::now();
  Admission::Ticket ticket = run.time_limit_s() > 0 ? queue_with_time_limit(run, demand, stop)
                                                    : services_.admission.enter(demand, stop);
  run.trace.timing.queue += milliseconds_since(start);
  return ticket;
}

Admission::Ticket RenderService::queue_with_time_limit(const Run& run, const SlotRequest& demand,
                                                       const std::stop_token& stop) {
  const double seconds = run.time_limit_s();
  std::stop_source late;
  const std::stop_callback forward(stop, [&] { late.request_stop(); });
  const auto alarm = services_.timer.at(
      run.since +
          std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds - run.before_s)),
      [&] { late.request_stop(); });
  try {
    Admission::Ticket ticket = services_.admission.enter(demand, late.get_token());
    ticket.set_stop(stop);
    return ticket;
  } catch (const Cancelled&) {
    if (stop.stop_requested()) throw;
    throw LimitExceeded("other clients used the service for longer than the image may take (limit " +
                            number_text(seconds) + " s, time_limit_seconds)",
                        limited_retry_s(seconds), "max_concurrent_renders");
  }
}

RenderResult RenderService::render_film(Run& run, FilmStorage storage, const std::stop_token& stop) {
  run.ticket.emplace(queue(run, run.demand, stop));
  run.trace.stage = Stage::render;
  RenderControl control = limits_of(run.scene(), run.order.plan);
  control.stop = stop;
  control.used_s = [this, &run] { return run.waited_s(services_.timer); };
  return WorkAccount::current()->run(stop, [&] {
    return services_.render(*run.ticket, run.demand.priority == Priority::batch, run.order, storage, control);
  });
}

Picture RenderService::encode(Run& run, const Films::LookupResult& film) {
  const RenderStats& stats = film.value->stats;
  Picture picture{.bytes = {},
                  .stats = stats,
                  .certificate = film.value->certificate,
                  .warnings = find_warnings(run.scene(), run.order.plan, stats.counts),
                  .budget = film.value->budget,
                  .from_cached_film = !film.made_here};
  run.trace.stage = Stage::encode;
  const auto start = Clock::now();
  picture.bytes = encode_film(film.value->film, run.order.format);
  picture.bytes.shrink_to_fit();  // it may be cached
  run.trace.timing.encode = milliseconds_since(start);
  if (picture.budget) {
    picture.budget->end_at(run.waited_s(services_.timer));
    require_met(*picture.budget, picture.certificate);
  }
  return picture;
}

void RenderService::require_request_rays(const Scene& scene, const Plan& plan) const {
  // Uses the smaller estimate, so that renders of other clients cannot cause a rejection.
  const double rays = ray_weight(scene, plan) *
                      std::min(services_.estimator.estimate(scene, plan), expected_rays(scene, plan));
  if (rays > request_rays_) throw TooManyRays(rays, request_rays_);
}

RenderControl RenderService::limits_of(const Scene& scene, const Plan& plan) const {
  return {.max_rays = request_rays_ / ray_weight(scene, plan),
          .max_s = kShareOfBudgets * static_cast<double>(services_.request_seconds.count())};
}

}  // namespace orrery
