#pragma once

#include <memory>
#include <optional>

#include "core/accuracy/tile_halves.h"
#include "core/cameras/pixel_filter.h"
#include "core/model/technique.h"
#include "core/render/backend.h"

namespace orrery {

// Renders tiles one after another on one thread.
template <class T>
class TileRenderer {
 public:
  // World and plan must outlive the renderer.
  TileRenderer(const World<T>& world, const Plan& plan);

  // Adds the tile's samples to the film. Calls checkpoint(). After an exception, the tile in the film is
  // unchanged, and the renderer must not be used again.
  void render(const TileView& tile, Film& film);

  // Adds the statistics of all rendered tiles to `stats`.
  void add_to(RenderStats& stats) const;

 private:
  // Traces one sample of every pixel.
  void trace(const TileView& tile, int sample);
  // Traces one sample of every pixel for the positive or the negative part of the pixel filter.
  void trace_part(const TileView& tile, int sample, PixelFilter::Part part, TraceResult<T>& into);
  // Subtracts the result for the negative part of the filter from the result for the positive part.
  void subtract_negative_lobe();
  // Generates camera rays through the samples. Lens positions and times are drawn from `set`.
  void send_rays(const TileView& tile, const TileSamples& samples, const Draws& draws, SampleSet set);
  // Chooses the numbers of emission samples and their random streams. trace_emission_only() traces the
  // samples.
  void begin_emission_rays(const TileView& tile);
  // Returns whether the emission varies in or next to each block of 4x4 pixels of the tile.
  using Blocks = std::array<bool, kBatch / 16>;
  Blocks find_varied_blocks(const TileView& tile);
  void trace_emission_only(const TileView& tile, int sample, PixelFilter::Part part, TraceResult<T>& into);
  void find_streams(const TileView& tile, SampleSet set, Array<std::uint32_t>& streams);
  void place_samples(std::uint32_t sample, const Array<std::uint32_t>& streams, PixelFilter::Part part,
                     TileSamples& to) const;
  void add_sample();
  void add_clamped(const TileView& tile);
  void add_error(const TileHalves& halves);
  void put_single(const TileView& tile, Film& film);
  // Replaces the radiance of each pixel by the colour of its error bound.
  void show_bound(const TileView& tile);

  const Plan& plan_;
  const bool places_samples_;  // false: samples are at the pixel centres
  TracerPtr<T> tracer_;
  // For each pixel of the current tile: random streams of the positions of samples and of emission samples.
  Array<std::uint32_t> pixel_streams_, emission_ray_streams_;
  TileSamples samples_ = TileSamples::centres(), look_samples_ = TileSamples::centres();
  // Registers of the current tile with one and with kMaxEmissionSamples emission samples for each sample.
  LaneGroups even_, varied_;
  RayBatch<T> rays_;
  TraceResult<T> result_;
  std::optional<PixelFilter> filter_;              // nullopt: samples are uniform over the pixel
  std::unique_ptr<TraceResult<T>> negative_lobe_;  // result for negative lobes; null if the filter has none
  TileSums sums_;
  std::array<TileSums::Plane, 3> first_half_;  // radiance of the first half of the samples
  TileMeans means_;
  // Light of untraced rays in the current tile, summed by channel and pixel. Empty if all rays were traced.
  std::vector<TileSums::Plane> omitted_;
  std::array<TileSums::Plane, 3> clamped_;  // set if Plan::clamp_indirect is above 0
  RenderStats stats_;
};

extern template class TileRenderer<float>;
extern template class TileRenderer<double>;

}  // namespace orrery
