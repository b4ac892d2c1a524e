#pragma once

#include "core/budget/pilot.h"

namespace orrery {

// Traces a subset of the pixels with few samples and extrapolates cost and error to the image. All results
// except times depend only on scene and plan. Immutable and thread-safe after construction.
class ForecastPilots {
 public:
  // Traces up to 16 whole tiles with 4 samples, and traces them again if this took less than 50 ms of CPU
  // time. Times and the effect of path reuse are measured on these tiles alone. Without path reuse, also
  // traces pilots with 16 and 4 samples. If the plan has one sample, every pilot has one. Throws the errors
  // in renderer.h except BudgetMissed.
  ForecastPilots(const PreparedScene& scene, const SettledPlan& plan, Executor& executor,
                 const RenderControl& control);

  // Return the rays, and their CPU seconds, for one sample in every pixel of the image.
  double rays_per_sample() const { return rays_per_sample_; }
  double cpu_s_per_sample() const { return rays_per_sample_ * cpu_s_per_ray_; }
  double build_ms() const { return build_ms_; }  // time to prepare the scene, if needed

  // Predicts the statistics of an image with `samples` samples per pixel. The light of untraced rays is that
  // of the pilot with the largest RMS of this light.
  RenderStats extrapolated(int samples) const;

 private:
  // Replaces last_ by `next`, but keeps the larger light of untraced rays.
  void go_on(const Pilot& next);

  const int samples_;  // samples per pixel of last_
  Pilot last_;         // pilot that is extrapolated
  double rays_per_sample_, cpu_s_per_ray_, build_ms_;
  double exponent_ = 1;  // mean square errors are proportional to samples^-exponent_
};

}  // namespace orrery
