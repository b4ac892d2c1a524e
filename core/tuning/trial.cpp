#include "core/tuning/trial.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/cameras/shutter.h"

namespace orrery {
namespace {

constexpr std::uint64_t kMaxRays = 1'000'000;

// Requests a stop once kMaxRays rays are counted.
class RayLimit final : public TimeSlice {
 public:
  RayLimit(const TraceCounts& counts, std::stop_source& enough) : counts_(counts), enough_(enough) {}
  void yield() override {
    if (counts_.rays.total() >= kMaxRays) enough_.request_stop();
  }

 private:
  const TraceCounts& counts_;
  std::stop_source& enough_;
};

}  // namespace

template <class T>
TraceCounts try_tiles(const World<T>& world, const Plan& plan, int most, std::stop_token stop) {
  const TileGrid tiles(plan.width, plan.height);
  const int count = std::min(most, tiles.size());
  const TracerPtr<T> tracer = make_tracer(*plan.technique, world, plan);
  const auto rays = std::make_unique<RayBatch<T>>();
  const auto result = std::make_unique<TraceResult<T>>();
  const TileSamples centres = TileSamples::centres();
  TraceCounts counts;
  std::stop_source ends;
  const std::stop_callback cancelled(stop, [&] { ends.request_stop(); });
  RayLimit limit(counts, ends);
  const Checkpoint checkpoint(ends.get_token(), &limit);
  for (int i = 0; i < count && checkpoint.may_continue(); ++i) {
    const TileView tile =
        tiles.at(static_cast<int>((std::int64_t{2} * i + 1) * tiles.size() / (2 * count)), 1);
    plan.camera->generate(plan.frame, plan.width, plan.height, tile, centres, *rays);
    if (plan.shutter > 0) put_middle_time(*rays);
    tracer->trace(*rays, Draws(plan.seed, tile, 0), *result, counts, checkpoint);
  }
  if (stop.stop_requested()) throw Cancelled();
  return counts;
}

template TraceCounts try_tiles(const World<float>&, const Plan&, int, std::stop_token);
template TraceCounts try_tiles(const World<double>&, const Plan&, int, std::stop_token);

}  // namespace orrery
