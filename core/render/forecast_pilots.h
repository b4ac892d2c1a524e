#pragma once

#include "core/render/pilot.h"

namespace orrery {

// Traces a subset of the pixels with few samples and extrapolates cost and error to the image. All results
// except times depend only on scene and plan.
class ForecastPilots {
 public:
  // Traces 16 whole tiles with 4 samples, and repeats this if it took little time. Times and the effect of
  // path reuse are measured on these tiles alone. Without path reuse, also traces pilots with 4 and 16
  // samples. Throws Cancelled once control.stop is requested.
  ForecastPilots(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                 const RenderControl& control);

  // Returns the number of rays for one sample in every pixel.
  double rays_per_sample() const { return rays_per_sample_; }
  double cpu_s_per_sample() const { return rays_per_sample_ * cpu_s_per_ray_; }
  double build_ms() const { return build_ms_; }  // time to prepare the scene, if needed

  // Predicts the statistics of an image with `samples` samples per pixel. For untraced rays, takes those of
  // the pilot with the largest error.
  RenderStats extrapolated(int samples) const;

 private:
  void go_on(const Pilot& next);

  const int samples_;  // samples per pixel of the error estimate
  Pilot last_;         // pilot that is extrapolated
  double rays_per_sample_, cpu_s_per_ray_, build_ms_;
  double exponent_ = 1;  // mean square errors are proportional to samples^-exponent_
};

}  // namespace orrery
