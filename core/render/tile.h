#pragma once

#include <array>
#include <stop_token>

#include "core/model/technique.h"
#include "core/render/renderer.h"

namespace orrery {

// Renders tiles, one after another, on one thread. Sums over samples are kept in double precision.
template <class T>
class TileRenderer {
 public:
  TileRenderer(const World<T>& world, const Plan& plan);

  // Sets the pixels of the tile whose first pixel is (x0, y0). Looks at `stop` now and then; once a
  // stop is requested the tile is left unfinished and stopped() is true.
  void render(int x0, int y0, std::stop_token stop, Image& image);
  bool stopped() const { return stopped_; }

  // Adds what the tiles so far took; mean_cut is summed, not yet divided.
  void add_to(RenderStats& stats) const;

 private:
  void place_samples(int x0, int y0, int sample);
  void clear_sums();
  void add_sample();
  void take_mean();
  void take_cut(int x0, int y0);
  void write(int x0, int y0, Image& image) const;

  const Plan& plan_;
  TracerPtr<T> tracer_;
  TileSamples samples_;
  RayBatch<T> rays_;
  TraceResult<T> result_;
  struct Sums {
    std::array<double, kBatch> red, green, blue, cut;
  } sums_;                                 // used if there are several samples
  Array<float> red_, green_, blue_, cut_;  // means, by slot
  RenderStats stats_;
  bool stopped_ = false;
};

extern template class TileRenderer<float>;
extern template class TileRenderer<double>;

}  // namespace orrery
