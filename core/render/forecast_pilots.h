#pragma once

#include "core/render/pilot.h"

namespace orrery {

// Traces a subset of pixels with few samples and extrapolates cost and error to the picture. All results but
// times depend on scene and plan alone.
class ForecastPilots {
 public:
  // Traces 16 whole tiles with 4 samples, twice if they are quick. Only these tiles measure time and reused
  // paths. If no paths are reused, also traces pilots with 4 and 16 samples. Throws Cancelled once
  // control.stop is requested.
  ForecastPilots(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                 const RenderControl& control);

  // Rays of one sample in every pixel.
  double rays_per_sample() const { return rays_per_sample_; }
  double cpu_s_per_sample() const { return rays_per_sample_ * cpu_s_per_ray_; }
  double build_ms() const { return build_ms_; }  // time to prepare the scene, if needed

  // Predicts the statistics of a picture with `samples` samples. For rays not traced, the worst pilot counts.
  RenderStats extrapolated(int samples) const;

 private:
  void go_on(const Pilot& next);

  const int samples_;  // samples per pixel of the error estimate
  Pilot last_;         // pilot that is extrapolated
  double rays_per_sample_, cpu_s_per_ray_, build_ms_;
  double exponent_ = 1;  // mean squares fall with samples^-exponent_
};

}  // namespace orrery
