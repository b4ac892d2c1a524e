#include <atomic>
#include <numeric>
#include <vector>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/render/geometry.h"
#include "core/render/prepare.h"
#include "core/render/tile.h"

namespace orrery {
namespace {

template <class T>
RenderResult render(const PreparedScene& scene, const Plan& plan, PixelFormat format, WorkerPool& pool,
                    const RenderControl& control) {
  RenderStats stats;
  const World<T> world = world_for<T>(scene.parts(), plan, stats.build_ms, control.stop);
  stats.accelerator = plan.accelerator;
  stats.structure = facts_of(world);
  Image image(plan.width, plan.height, format);
  std::vector<std::unique_ptr<TileRenderer<T>>> renderers(static_cast<std::size_t>(pool.threads()));
  const int across = (plan.width + kTileSide - 1) / kTileSide,
            down = (plan.height + kTileSide - 1) / kTileSide;
  std::vector<double> cpu_ms(renderers.size());
  std::atomic<int> done = 0;
  std::atomic<bool> stopped = false;
  const auto start = Clock::now();
  pool.for_each(across * down, control.background, [&](int tile, int thread) {
    if (control.stop.stop_requested()) stopped = true;
    if (stopped) return false;
    const double cpu_before = thread_cpu_ms();
    auto& renderer = renderers[static_cast<std::size_t>(thread)];
    if (!renderer) renderer = std::make_unique<TileRenderer<T>>(world, plan);
    renderer->render(tile % across * kTileSide, tile / across * kTileSide, control.stop, image);
    cpu_ms[static_cast<std::size_t>(thread)] += thread_cpu_ms() - cpu_before;
    if (control.progress) control.progress(++done, across * down);
    return true;
  });
  for (const auto& renderer : renderers) {
    if (!renderer) continue;
    stopped = stopped || renderer->stopped();
    renderer->add_to(stats);
  }
  if (stopped) throw Cancelled();
  stats.mean_cut /= static_cast<double>(plan.width) * plan.height;
  stats.trace_ms = milliseconds_since(start);
  stats.cpu_ms = std::accumulate(cpu_ms.begin(), cpu_ms.end(), 0.0);
  return {std::move(image), stats};
}

}  // namespace

RenderResult render_frame(const PreparedScene& scene, const Plan& plan, PixelFormat format, WorkerPool& pool,
                          const RenderControl& control) {
  if (plan.try_accelerators) {
    Plan settled = plan;
    const double took_ms = settle(scene, settled, control.stop);
    RenderResult result = render_frame(scene, settled, format, pool, control);
    result.stats.build_ms += took_ms;
    return result;
  }
  return plan.double_precision ? render<double>(scene, plan, format, pool, control)
                               : render<float>(scene, plan, format, pool, control);
}

}  // namespace orrery
