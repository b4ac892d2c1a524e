#include "core/render/pilot.h"

#include <vector>

#include "core/math/sampling.h"

namespace orrery {
namespace {

constexpr int kSide = 4;
constexpr int kLeastBlocks = 64;  // of a picture that has as many

// Adds some blocks of a tile, evenly spaced from the one that chance names by the tile's number.
void add_blocks(const TileView& tile, int number, int wanted, std::vector<TileView>& blocks) {
  const int across = (tile.width + kSide - 1) / kSide, down = (tile.height + kSide - 1) / kSide;
  const int all = across * down, some = std::min(wanted, all);
  const int first =
      static_cast<int>(mix_bits(static_cast<std::uint32_t>(number)) % static_cast<std::uint32_t>(all));
  for (int i = 0; i < some; ++i) {
    const int block = (first + i * all / some) % all;
    const int x = block % across * kSide, y = block / across * kSide;
    TileView view = tile;
    view.x0 += x;
    view.y0 += y;
    view.width = std::min(kSide, tile.width - x);
    view.height = std::min(kSide, tile.height - y);
    blocks.push_back(view);
  }
}

}  // namespace

RenderStats trace_pilot(const PreparedScene& scene, const SettledPlan& plan, int samples, WorkerPool& pool,
                        const RenderControl& control) {
  const TileGrid grid(plan->width, plan->height);
  const int of_each = (kLeastBlocks + grid.size() - 1) / grid.size();
  std::vector<TileView> blocks;
  for (int i = 0; i < grid.size(); ++i) add_blocks(grid.at(i, samples), i, of_each, blocks);
  RenderStats stats;
  const auto prepared = threads_backend(pool)->prepare(scene, plan, stats, control.stop);
  Film forgotten(plan->width, plan->height, FilmStorage::srgb8);
  prepared->render(blocks, forgotten, stats,
                   {.stop = control.stop, .background = control.background, .pass = control.pass});
  return stats;
}

}  // namespace orrery
