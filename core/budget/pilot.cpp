#include "core/budget/pilot.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/math/sampling.h"

namespace orrery {
namespace {

constexpr int kSide = 4;        // side of a block, in pixels
constexpr int kMinBlocks = 64;  // blocks of a pilot; fewer if the image has fewer

Pilot trace(std::span<const TileView> views, const PreparedScene& scene, const SettledPlan& plan,
            Executor& executor, const RenderControl& control) {
  Pilot pilot{};
  const auto prepared = threads_backend(executor)->prepare(scene, plan, pilot.stats, control.stop);
  Film forgotten(plan->width, plan->height, FilmStorage::srgb8);
  prepared->render(views, forgotten, pilot.stats, {.stop = control.stop});
  double pixels = 0;
  for (const TileView& view : views) pixels += view.width * view.height;
  pilot.share = pixels / plan->width / plan->height;
  return pilot;
}

// Returns a pseudorandom number in [0, end). The number depends only on `i` and `end`.
int below(int end, int i) {
  return static_cast<int>(mix_bits(static_cast<std::uint32_t>(i)) % static_cast<std::uint32_t>(end));
}

// Adds up to `wanted` evenly spaced blocks of a tile. The first block is pseudorandom and depends on the
// number of the tile.
void add_blocks(const TileView& tile, int number, int wanted, std::vector<TileView>& blocks) {
  const int across = (tile.width + kSide - 1) / kSide, down = (tile.height + kSide - 1) / kSide;
  const int all = across * down, some = std::min(wanted, all);
  const int first = below(all, number);
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

Pilot trace_pilot(const PreparedScene& scene, const SettledPlan& plan, int samples, Executor& executor,
                  const RenderControl& control) {
  const TileGrid grid(plan->width, plan->height);
  const int of_each = (kMinBlocks + grid.size() - 1) / grid.size();
  std::vector<TileView> blocks;
  for (int i = 0; i < grid.size(); ++i) add_blocks(grid.at(i, samples), i, of_each, blocks);
  return trace(blocks, scene, plan, executor, control);
}

Pilot trace_tiles(const PreparedScene& scene, const SettledPlan& plan, int most, int samples,
                  Executor& executor, const RenderControl& control) {
  const TileGrid grid(plan->width, plan->height);
  const int count = std::min(most, grid.size());
  std::vector<TileView> tiles;
  for (int i = 0; i < count; ++i) {  // one tile from each of `count` equal ranges of tile numbers
    const int begin = i * grid.size() / count, end = (i + 1) * grid.size() / count;
    tiles.push_back(grid.at(begin + below(end - begin, i), samples));
  }
  return trace(tiles, scene, plan, executor, control);
}

}  // namespace orrery
