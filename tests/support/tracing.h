#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/model/technique.h"
#include "core/model/world.h"
#include "core/plan/plan.h"
#include "tests/support/scenes.h"

// Traces single rays with a technique in double precision, without a camera or rounding to float. Records all
// rays that the technique traces.
namespace orrery::test {

struct TraceOutput {
  Vec3d radiance;
  Vec3d weights;  // summed weights of the rays that were not traced, or the bound of their light
  double cut;     // largest component of `weights`
};

class Tracing {
 public:
  enum class Ledger { weights, light };  // meaning of TraceOutput::weights
  // Ignores the precision and the slice of the request.
  explicit Tracing(const std::shared_ptr<const Scene>& scene, RenderRequest request = {},
                   Ledger ledger = Ledger::weights);
  explicit Tracing(const Json& scene, RenderRequest request = {});
  ~Tracing();

  TraceOutput trace(const Ray<double>& ray);
  // Traces up to kBatch rays as one batch, with the random numbers of one sample.
  std::vector<TraceOutput> trace(const std::vector<Ray<double>>& rays, int sample = 0);

  // Rays of the last trace by depth, without shadow rays.
  using Generations = std::vector<std::vector<Ray<double>>>;
  const Generations& rays() const;
  const std::vector<Ray<double>>& shadow_rays() const;
  const TraceCounts& counts() const { return counts_; }  // sum over all traces
  const World<double>& world() const { return world_; }

 private:
  class Recorder;
  Plan plan_;
  World<double> world_;
  Recorder* recorder_ = nullptr;  // the world's accelerator
  TracerPtr<double> tracer_;
  TraceCounts counts_;
};

struct Estimate {
  double mean, sd;  // over batch elements, each the mean of its samples
  double error() const { return sd / std::sqrt(double{kBatch}); }
};
// Estimates the red radiance along one ray from the elements of a batch. The elements are independent unless
// paths are reused. The `samples` of an element are stratified.
Estimate estimate(const std::shared_ptr<const Scene>& scene, const Vec3d& from, const Vec3d& toward,
                  int max_depth, const char* technique = "path");
Estimate estimate(const Json& scene, const Vec3d& from, const Vec3d& toward, int max_depth,
                  const char* technique = "path");
Estimate estimate_alone(const Json& scene, const Vec3d& from, const Vec3d& toward, int max_depth,
                        int samples);  // technique path, without path reuse

// Returns the radiance of every pixel in double precision, without rounding to float.
std::vector<Vec3d> trace_picture(const Json& scene, const RenderRequest& request);

}  // namespace orrery::test
