#include "server/rendering/refinement.h"

#include <utility>

#include "core/base/clock.h"
#include "core/plan/warnings.h"
#include "core/render/views.h"
#include "server/rendering/picture_key.h"
#include "server/scheduler/watch.h"

namespace orrery {

Refinement::Refinement(RefinementSpec spec, const RenderServices& services, Pictures& pictures,
                       std::chrono::seconds pass_time)
    : spec_(std::move(spec)),
      services_(services),
      pictures_(pictures),
      pass_time_(pass_time),
      samples_(progressive_samples(spec_.plan)),
      known_(pictures.find(key_of(spec_.plan.samples))),
      memory_(services.memory.open(spec_.client)),
      executor_(services.pool) {}

std::string Refinement::key_of(int samples) const {
  RenderRequest request = spec_.request;
  request.samples = samples;
  return picture_key(work_key(spec_.scene->scene(), request), FileFormat::png);
}

std::optional<Refinement::Step> Refinement::next(const std::stop_token& gone) {
  if (done_ > 0 && services_.draining.stop_requested()) next_ = samples_.size();
  if (at_end()) return std::nullopt;
  if (known_) {
    next_ = samples_.size();
    ++services_.meters.pictures_found;
    return Step{.samples = spec_.plan.samples, .picture = known_};
  }
  const WorkCancellation watch(gone, services_.ends, services_.timer, services_.timer.now(),
                               {pass_time_, "request_seconds"});
  const std::stop_token stop = watch.stop();
  Stage stage = Stage::queue;
  const std::size_t pass = std::exchange(next_, samples_.size());  // at_end() if render() throws
  try {
    Step step = memory_->run(stop, [&] { return render(samples_[pass], stop, stage); });
    next_ = pass + 1;
    return step;
  } catch (const Cancelled&) {
    ++services_.meters.cancelled[static_cast<std::size_t>(stage)];
    watch.explain();
  }
}

Refinement::Step Refinement::render(int samples, const std::stop_token& stop, Stage& stage) {
  const Scene& scene = spec_.scene->scene();
  Plan pass = spec_.plan;  // for the cost of this pass
  pass.samples = samples - done_;
  const SlotRequest demand = services_.demand_of(scene, pass, spec_.client);
  auto ticket =
      progress_ ? services_.admission.enter_again(demand, stop) : services_.admission.enter(demand, stop);
  stage = Stage::render;
  if (!progress_) {
    const SceneStore::SizeGuard measured(services_.scenes, *spec_.scene);
    progress_ = std::make_unique<ProgressiveRender>(*spec_.scene, settle(*spec_.scene, spec_.plan, stop),
                                                    executor_, stop);
  }
  const RenderStats& stats = progress_->stats();
  const std::uint64_t rays_before = stats.counts.rays.total();
  const double ms_before = done_ > 0 ? stats.build_ms + stats.trace_ms : 0;
  executor_.background = demand.priority == Priority::batch;
  executor_.lease = &ticket;
  progress_->refine(samples, {.stop = stop});
  done_ = samples;
  Step step{.samples = samples,
            .picture = {},
            .render_ms = stats.build_ms + stats.trace_ms - ms_before,
            .rays = stats.counts.rays.total() - rays_before};
  services_.count(ticket, scene, pass, step.rays, step.render_ms);
  stage = Stage::encode;
  const auto start = Clock::now();
  Picture picture{.bytes = encode_film(progress_->film(), FileFormat::png),
                  .stats = stats,
                  .certificate = certify(plan(), stats),
                  .warnings = find_warnings(scene, spec_.plan, stats.counts)};
  picture.bytes.shrink_to_fit();  // it may be cached
  step.encode_ms = milliseconds_since(start);
  step.picture = std::make_shared<const Picture>(std::move(picture));
  pictures_.keep(key_of(samples), spec_.client, step.picture);
  ++services_.meters.films_made;
  ++services_.meters.pictures_made;
  return step;
}

}  // namespace orrery
