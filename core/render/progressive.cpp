#include "core/render/progressive.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/base/task_scope.h"
#include "core/model/technique.h"

namespace orrery {
namespace {

// Throws std::bad_alloc if the memory account of the task refuses `bytes` more bytes, and Cancelled.
// Allocates nothing.
void require_memory(std::size_t bytes) {
  const MemoryCharge charge(bytes);
  checkpoint();
}

// Returns an empty film for the plan.
Film make_film(const Plan& plan, FilmStorage storage) {
  std::span<const ChannelType* const> channels;
  if (storage == FilmStorage::sums) channels = plan.channels;
  require_memory(Film::bytes(plan.width, plan.height, storage, channels));
  return Film(plan.width, plan.height, storage, channels);
}

// Returns all tiles of a film, each with `samples` samples that start at `first_sample`.
std::vector<TileView> tiles_of(const Film& film, int first_sample, int samples) {
  const TileGrid grid(film.width(), film.height());
  std::vector<TileView> tiles;
  tiles.reserve(static_cast<std::size_t>(grid.size()));
  for (int i = 0; i < grid.size(); ++i) {
    tiles.push_back(grid.at(i, samples));
    tiles.back().first_sample = first_sample;
  }
  return tiles;
}

// Reorders the tiles in steps of about 0.618 of their number (golden ratio), so that any prefix is spread
// over the whole image.
std::vector<TileView> spread(const std::vector<TileView>& tiles) {
  const std::size_t size = tiles.size();
  auto step = static_cast<std::size_t>(0.618 * static_cast<double>(size));
  while (std::gcd(step, size) != 1) ++step;
  std::vector<TileView> order;
  order.reserve(size);
  for (std::size_t i = 0; i < size; ++i) order.push_back(tiles[i * step % size]);
  return order;
}

}  // namespace

Film render_film(const PreparedScene& scene, const SettledPlan& plan, FilmStorage storage, Executor& executor,
                 RenderStats& stats, const RenderControl& control) {
  stats.build_ms += plan.settle_ms();
  const auto prepared = threads_backend(executor)->prepare(scene, plan, stats, control.stop);
  Film film = make_film(*plan, storage);
  prepared->render(tiles_of(film, 0, plan->samples), film, stats, control);
  return film;
}

std::vector<int> progressive_samples(const Plan& plan) {
  std::vector<int> samples;
  const bool middle = plan.samples > 1 && !plan.technique->draws_light;
  for (int n = plan.samples; n > (middle ? 1 : 0); n /= 2) samples.push_back(n);
  std::reverse(samples.begin(), samples.end());
  return samples;
}

ProgressiveRender::ProgressiveRender(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                                     std::stop_token stop)
    : prepared_(threads_backend(executor)->prepare(scene, plan, stats_, stop)),
      film_(make_film(*plan, FilmStorage::sums)) {
  stats_.build_ms += plan.settle_ms();
}

void ProgressiveRender::refine(int samples, const RenderControl& control) {
  const FilmError before = std::exchange<FilmError>(stats_, {});
  const std::vector<TileView> tiles = tiles_of(film_, samples_, samples - samples_);
  prepared_->render(control.spread ? spread(tiles) : tiles, film_, stats_, control);
  if (samples_ > 0) stats_.join(before);
  samples_ = samples;
}

}  // namespace orrery
