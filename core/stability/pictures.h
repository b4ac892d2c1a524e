#pragma once

#include <memory>
#include <vector>

#include "core/plan/request.h"
#include "core/render/renderer.h"

namespace orrery {

// What the plan of a scene renders, on one thread.
RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request);

// Red, green and blue of all pixels, linear. REQUIRES: as Film::image() of linear32.
std::vector<float> values_of(const Film& film);

// One tile whose samples are traced one after another. REQUIRES: the picture is that tile, at most 32 x 32.
class SampledTile {
 public:
  SampledTile(const std::shared_ptr<const Scene>& scene, const RenderRequest& request);

  // Traces that many samples more, and gives the sums of all so far.
  const TileSums& add(int samples);
  // Of what was traced last, where it began with the first sample.
  const SampledError& error() const { return stats_.error; }

 private:
  PreparedScene prepared_;
  SettledPlan plan_;
  WorkerPool pool_;
  RenderStats stats_;
  std::unique_ptr<Prepared> ready_;
  Film film_;
  TileSums sums_;
};

}  // namespace orrery
