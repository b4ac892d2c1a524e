#include <vector>

#include "core/base/work_scope.h"
#include "core/render/renderer.h"

namespace orrery {
namespace {

// Throws std::bad_alloc unless the work may hold so many bytes more, before it touches any of them.
void require_memory(std::size_t bytes) {
  const MemoryCharge charge(bytes);
  interruption_point();
}

}  // namespace

RenderResult render_frame(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage,
                          WorkerPool& pool, const RenderControl& control) {
  RenderStats stats;
  stats.build_ms = plan.settle_ms();
  const auto prepared = threads_backend(pool)->prepare(scene, plan, stats, control.stop);
  std::span<const ChannelType* const> channels;
  if (storage == FilmStorage::sums) channels = plan->channels;
  require_memory(Film::bytes(plan->width, plan->height, storage, channels));
  Film film(plan->width, plan->height, storage, channels);
  const TileGrid grid(plan->width, plan->height);
  std::vector<TileView> tiles;
  tiles.reserve(static_cast<std::size_t>(grid.size()));
  for (int i = 0; i < grid.size(); ++i) tiles.push_back(grid.at(i, plan->samples));
  prepared->render(tiles, film, stats, control);
  return {std::move(film), stats};
}

}  // namespace orrery
