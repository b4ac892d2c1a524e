#include "core/tuning/trial.h"

#include <algorithm>

#include "core/base/error.h"

namespace orrery {

template <class T>
TraceCounts try_tiles(const World<T>& world, const Plan& plan, int most, std::stop_token stop) {
  const TileGrid tiles(plan.width, plan.height);
  const int count = std::min(most, tiles.size());
  const TracerPtr<T> tracer = make_tracer(*plan.technique, world, plan);
  const auto rays = std::make_unique<RayBatch<T>>();
  const auto result = std::make_unique<TraceResult<T>>();
  const TileSamples centres = TileSamples::centres();
  TraceCounts counts;
  for (int i = 0; i < count; ++i) {
    const TileView tile =
        tiles.at(static_cast<int>((std::int64_t{2} * i + 1) * tiles.size() / (2 * count)), 1);
    plan.camera->generate(plan.frame, plan.width, plan.height, tile, centres, *rays);
    if (stop.stop_requested() || !tracer->trace(*rays, Draws(plan.seed, tile, 0), *result, counts, stop))
      throw Cancelled();
  }
  return counts;
}

template TraceCounts try_tiles(const World<float>&, const Plan&, int, std::stop_token);
template TraceCounts try_tiles(const World<double>&, const Plan&, int, std::stop_token);

}  // namespace orrery
