#pragma once

#include <memory>
#include <vector>

#include "core/plan/request.h"
#include "core/render/renderer.h"

namespace orrery {

// Renders a scene as planned, on one thread.
RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request);

// Returns linear red, green and blue of all pixels. REQUIRES: the film can be converted to linear32; see
// Film::image().
std::vector<float> values_of(const Film& film);

// Image of one tile whose samples are traced in steps. REQUIRES: the image has at most 32 x 32 pixels.
class SampledTile {
 public:
  SampledTile(const std::shared_ptr<const Scene>& scene, const RenderRequest& request);

  // Traces `samples` more samples per pixel and returns the sums of all samples.
  const TileSums& add(int samples);
  // Returns the estimated error of the samples that the last add() traced. REQUIRES: it was the first add().
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
