#include "core/render/trial.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/model/camera.h"

namespace orrery {

template <class T>
TraceCounts try_tiles(const World<T>& world, const Plan& plan, int most, std::stop_token stop) {
  const int across = (plan.width + kTileSide - 1) / kTileSide,
            down = (plan.height + kTileSide - 1) / kTileSide;
  const int tiles = across * down, count = std::min(most, tiles);
  const TracerPtr<T> tracer = make_tracer(*plan.technique, world, plan);
  const auto rays = std::make_unique<RayBatch<T>>();
  const auto result = std::make_unique<TraceResult<T>>();
  TileSamples middle;
  middle.u.values.fill(0.5f);
  middle.v.values.fill(0.5f);
  TraceCounts counts;
  for (int i = 0; i < count; ++i) {
    const int tile = static_cast<int>((std::int64_t{2} * i + 1) * tiles / (2 * count));
    generate_rays(plan.camera, plan.width, plan.height, tile % across * kTileSide, tile / across * kTileSide,
                  middle, *rays);
    if (stop.stop_requested() || !tracer->trace(*rays, *result, counts, stop)) throw Cancelled();
  }
  return counts;
}

template TraceCounts try_tiles(const World<float>&, const Plan&, int, std::stop_token);
template TraceCounts try_tiles(const World<double>&, const Plan&, int, std::stop_token);

}  // namespace orrery
