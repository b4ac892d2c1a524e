#pragma once

#include <memory>
#include <optional>

#include "core/cameras/pixel_filter.h"
#include "core/model/technique.h"
#include "core/render/backend.h"
#include "core/render/tile_halves.h"

namespace orrery {

// Renders tiles, one after another, on one thread.
template <class T>
class TileRenderer {
 public:
  // World and plan outlive it.
  TileRenderer(const World<T>& world, const Plan& plan);

  // Adds the tile's samples to the film. False once the work is to end: the tile is then left as it was.
  bool render(const TileView& tile, const Checkpoint& checkpoint, Film& film);

  // Adds what the tiles so far took.
  void add_to(RenderStats& stats) const;

 private:
  // Traces one sample of every pixel. False once the work is to end.
  bool trace(const TileView& tile, int sample, const Checkpoint& checkpoint);
  // Of what a part of the pixel's filter sees.
  bool trace_part(const TileView& tile, int sample, PixelFilter::Part part, TraceResult<T>& into,
                  const Checkpoint& checkpoint);
  // Puts the parts together.
  void take_away();
  // Camera rays through these places, from the lens and at times that are drawn from `set`.
  void send_rays(const TileView& tile, const TileSamples& samples, const Draws& draws, SampleSet set);
  // Has the tracer look elsewhere within the pixels.
  void begin_looks(const TileView& tile);
  void look(const TileView& tile, int sample, PixelFilter::Part part, TraceResult<T>& into);
  void find_streams(const TileView& tile, SampleSet set, Array<std::uint32_t>& streams);
  void place_samples(std::uint32_t sample, const Array<std::uint32_t>& streams, PixelFilter::Part part,
                     TileSamples& to) const;
  void add_sample();
  void add_clamped(const TileView& tile);
  void add_error(const TileHalves& halves);
  void put_single(const TileView& tile, Film& film);
  // Puts colours in the place of the radiance.
  void show_bound(const TileView& tile);

  const Plan& plan_;
  const bool places_samples_;  // elsewhere than at the pixels' centres
  TracerPtr<T> tracer_;
  // By slot: where the samples' places within this tile's pixels come from, and those of looks.
  Array<std::uint32_t> pixel_streams_, look_streams_;
  TileSamples samples_ = TileSamples::centres(), look_samples_ = TileSamples::centres();
  int looks_ = 0;  // of this tile, a sample
  RayBatch<T> rays_;
  TraceResult<T> result_;
  std::optional<PixelFilter> filter_;           // none: samples lie in their pixels evenly
  std::unique_ptr<TraceResult<T>> taken_away_;  // by its negative lobes; null if it has none
  TileSums sums_;
  std::array<TileSums::Plane, 3> first_half_;  // of the radiance, after half of the tile's samples
  TileMeans means_;
  // The ledger of this tile, sums by channel and slot; empty as long as nothing was left out.
  std::vector<TileSums::Plane> omitted_;
  std::array<TileSums::Plane, 3> clamped_;  // likewise; set if Plan::clamp_indirect is above 0
  RenderStats stats_;
};

extern template class TileRenderer<float>;
extern template class TileRenderer<double>;

}  // namespace orrery
