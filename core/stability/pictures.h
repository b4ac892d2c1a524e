#pragma once

#include <memory>
#include <vector>

#include "core/budget/renderer.h"
#include "core/plan/request.h"

namespace orrery {

// Renders a scene with the plan of the request, on one thread. Throws the errors of render_frame().
RenderResult rendered(const std::shared_ptr<const Scene>& scene, const RenderRequest& request);

// Returns linear red, green and blue of all pixels, row by row. REQUIRES: film.storage() is not srgb8.
std::vector<float> values_of(const Film& film);

// Image of one tile whose samples are traced in steps. Not thread-safe. REQUIRES: the image has at most 32 x
// 32 pixels.
class SampledTile {
 public:
  SampledTile(const std::shared_ptr<const Scene>& scene, const RenderRequest& request);

  // Traces `samples` more samples per pixel and returns the sums of all samples.
  const TileSums& add(int samples);
  // Returns the error estimated from the samples of the first add(). REQUIRES: add() was called exactly once.
  const SampledError& error() const { return stats_.error; }

 private:
  PreparedScene prepared_;
  SettledPlan plan_;
  ThreadExecutor executor_;
  RenderStats stats_;
  std::unique_ptr<Prepared> ready_;
  Film film_;
  TileSums sums_;
};

}  // namespace orrery
