#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "core/model/technique.h"
#include "core/model/world.h"
#include "core/plan/plan.h"
#include "tests/support/scenes.h"

// Single rays through the technique itself, in double precision: no camera, no picture, no rounding to float;
// and every ray that it sends on the way.
namespace orrery::test {

struct Answer {
  Vec3d radiance;
  Vec3d weights;  // the ledger: of the rays that were not traced
  double cut;     // the largest of these
};

class Tracing {
 public:
  // The request's precision is ignored.
  explicit Tracing(const std::shared_ptr<const Scene>& scene, RenderRequest request = {});
  explicit Tracing(const Json& scene, RenderRequest request = {});
  ~Tracing();

  Answer trace(const Ray<double>& ray);
  // Up to kBatch rays at once, as a tile would be, with the random numbers of one of its samples.
  std::vector<Answer> trace(const std::vector<Ray<double>>& rays, int sample = 0);

  // The rays of the last trace by depth, shadow rays apart.
  using Generations = std::vector<std::vector<Ray<double>>>;
  const Generations& rays() const;
  const std::vector<Ray<double>>& shadow_rays() const;
  const TraceCounts& counts() const { return counts_; }  // of all traces so far
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
  double mean, sd;  // of one slot's samples together
  double error() const { return sd / std::sqrt(double{kBatch}); }
};
// Of the red light along one ray that a technique finds, from the slots of a batch, which are independent of
// each other unless their paths share what they find; the `samples` of a slot are stratified.
Estimate estimate(const std::shared_ptr<const Scene>& scene, const Vec3d& from, const Vec3d& toward,
                  int max_depth, const char* technique = "path");
Estimate estimate(const Json& scene, const Vec3d& from, const Vec3d& toward, int max_depth,
                  const char* technique = "path");
Estimate estimate_alone(const Json& scene, const Vec3d& from, const Vec3d& toward, int max_depth,
                        int samples);  // by paths, with reuse 1

// Radiance of every pixel in double precision, without the picture's rounding to float.
std::vector<Vec3d> trace_picture(const Json& scene, const RenderRequest& request);

}  // namespace orrery::test
