#pragma once

#include "core/render/pilot.h"

namespace orrery {

// Pixels of a picture that are traced with few samples, and what they tell of all of them with more. Depends
// on scene and plan alone, but for times.
class ForecastPilots {
 public:
  // Traces 16 whole tiles with 4 samples, twice where they are quick, which alone tell time and what reused
  // paths bring; where none are reused also pilots with 4 and 16. Throws Cancelled once control.stop is
  // requested.
  ForecastPilots(const PreparedScene& scene, const SettledPlan& plan, WorkerPool& pool,
                 const RenderControl& control);

  // Of a sample of all pixels.
  double rays_per_sample() const { return rays_per_sample_; }
  double cpu_s_per_sample() const { return rays_per_sample_ * cpu_s_per_ray_; }
  double build_ms() const { return build_ms_; }  // making the scene ready, where it was not yet

  // What a picture of so many samples may tell. Of what is not traced, the worst that was seen counts.
  RenderStats foretold(int samples) const;

 private:
  void go_on(const Pilot& next);

  const int samples_;  // of those that tell the errors
  Pilot last_;         // which tells what others do
  double rays_per_sample_, cpu_s_per_ray_, build_ms_;
  double exponent_ = 1;  // of the samples, with which mean squares fall
};

}  // namespace orrery
