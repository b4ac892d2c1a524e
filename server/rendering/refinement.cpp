#include "server/rendering/refinement.h"

#include <utility>

#include "core/base/clock.h"
#include "core/plan/warnings.h"
#include "core/render/views.h"
#include "server/rendering/picture_key.h"

namespace orrery {

Refinement::Refinement(RenderOrder order, const RenderServices& services, Pictures& pictures)
    : order_(std::move(order)),
      services_(services),
      pictures_(pictures),
      samples_(progressive_samples(plan())),
      known_(pictures.find(key_of(plan().samples))),
      memory_(services.memory.open(order_.caller.client)),
      executor_(services.pool) {}

std::string Refinement::key_of(int samples) const {
  RenderRequest request = order_.request;
  request.samples = samples;
  return picture_key(work_key(scene(), request), order_.format);
}

std::optional<Refinement::Step> Refinement::next() {
  if (done_ > 0 && services_.draining.stop_requested()) next_ = samples_.size();
  if (at_end()) return std::nullopt;
  if (known_) {
    next_ = samples_.size();
    ++services_.meters.pictures_found;
    return Step{.samples = plan().samples, .picture = known_};
  }
  RequestTrace trace{.stage = Stage::queue};
  const std::size_t pass = std::exchange(next_, samples_.size());  // at_end() if render() throws
  Step step = services_.run(order_.caller, services_.timer.now(), trace, *memory_,
                            [&](const std::stop_token& stop) { return render(samples_[pass], stop, trace); });
  next_ = pass + 1;
  return step;
}

Refinement::Step Refinement::render(int samples, const std::stop_token& stop, RequestTrace& trace) {
  Plan pass = plan();  // for the cost of this pass
  pass.samples = samples - done_;
  const SlotRequest demand = services_.demand_of(scene(), pass, order_.caller);
  auto ticket =
      progress_ ? services_.admission.enter_again(demand, stop) : services_.admission.enter(demand, stop);
  trace.stage = Stage::render;
  if (!progress_) {
    const SceneStore::SizeGuard measured(services_.scenes, *order_.scene);
    progress_ = std::make_unique<ProgressiveRender>(*order_.scene, settle(*order_.scene, plan(), stop),
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
  services_.count(ticket, scene(), pass, step.rays, step.render_ms);
  trace.stage = Stage::encode;
  const auto start = Clock::now();
  Picture picture{.bytes = encode_film(progress_->film(), order_.format),
                  .stats = stats,
                  .certificate = certify(plan(), stats),
                  .warnings = find_warnings(scene(), plan(), stats.counts)};
  picture.bytes.shrink_to_fit();  // it may be cached
  picture.stats.halves = {};
  step.encode_ms = milliseconds_since(start);
  step.picture = std::make_shared<const Picture>(std::move(picture));
  pictures_.keep(key_of(samples), order_.caller.client, step.picture);
  ++services_.meters.films_made;
  ++services_.meters.pictures_made;
  return step;
}

}  // namespace orrery
