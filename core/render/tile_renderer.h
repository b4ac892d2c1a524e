#pragma once

#include "core/model/technique.h"
#include "core/render/backend.h"

namespace orrery {

// Renders tiles, one after another, on one thread.
template <class T>
class TileRenderer {
 public:
  // World and plan outlive it.
  TileRenderer(const World<T>& world, const Plan& plan);

  // Adds the tile's samples to the film. False once a stop was requested: the tile is then left as it was.
  bool render(const TileView& tile, std::stop_token stop, Film& film);

  // Adds what the tiles so far took; mean_cut is a sum over them, by pixels of the picture.
  void add_to(RenderStats& stats) const;

 private:
  void place_samples(const Draws& draws);
  void add_sample();
  void account_cut(const TileView& tile);

  const Plan& plan_;
  TracerPtr<T> tracer_;
  TileSamples samples_ = TileSamples::centres();
  RayBatch<T> rays_;
  TraceResult<T> result_;
  TileSums sums_;
  TileSums::Plane cut_;
  RenderStats stats_;
};

extern template class TileRenderer<float>;
extern template class TileRenderer<double>;

}  // namespace orrery
