#include "core/prepare/trial.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/cameras/shutter.h"

namespace orrery {
namespace {

constexpr std::uint64_t kMaxRays = 1'000'000;

struct EnoughRays {};

// Throws EnoughRays once kMaxRays rays are counted.
class RayLimit final : public TimeSlice {
 public:
  explicit RayLimit(const TraceCounts& counts) : counts_(counts) {}
  void yield() override {
    if (counts_.rays.total() >= kMaxRays) throw EnoughRays();
  }

 private:
  const TraceCounts& counts_;
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
  RayLimit limit(counts);
  const TaskScope scope({TaskScope::current().memory, &stop, &limit});
  try {
    for (int i = 0; i < count; ++i) {
      checkpoint();
      const TileView tile =
          tiles.at(static_cast<int>((std::int64_t{2} * i + 1) * tiles.size() / (2 * count)), 1);
      plan.camera->generate(plan.frame, plan.width, plan.height, tile, centres, *rays);
      if (plan.shutter > 0) put_middle_time(*rays);
      tracer->trace(*rays, Draws(plan.seed, tile, 0), *result, counts);
    }
  } catch (const EnoughRays&) {
  }
  return counts;
}

template TraceCounts try_tiles(const World<float>&, const Plan&, int, std::stop_token);
template TraceCounts try_tiles(const World<double>&, const Plan&, int, std::stop_token);

}  // namespace orrery
