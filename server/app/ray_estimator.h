#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "server/app/lru.h"

namespace orrery {

// Estimates the number of rays of renders, and learns from finished ones. Safe from any thread.
class RayEstimator {
 public:
  // Returns the estimated rays of all kinds: expected_rays() of the plan times a learned factor. Renders of a
  // scene with the same technique, depth and least contribution share a factor, whatever their size, samples
  // and camera. It starts at 1 and stays within 1/8 and 8, because a client's renders affect the estimates of
  // others.
  double estimate(const Scene& scene, const Plan& plan);
  // Learns from a complete render of the plan that traced `rays`. The first render sets the factor. Later
  // ones move it half of the way, because orbits change the view. An image of fewer than 4,096 camera rays
  // moves the factor proportionally less.
  void learn(const Scene& scene, const Plan& plan, std::uint64_t rays);

 private:
  static constexpr std::size_t kMaxFactors = 1024;  // most recently used ones

  Lru<std::shared_ptr<double>> factors_{kMaxFactors, Clock::duration::max()};
  std::mutex mutex_;  // guards the numbers that factors_ points to
};

}  // namespace orrery
