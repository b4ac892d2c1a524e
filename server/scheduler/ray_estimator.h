#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "server/base/lru.h"

namespace orrery {

// Estimates the number of rays of renders, and learns from finished ones. Thread-safe.
class RayEstimator {
 public:
  // Returns the estimated rays of all kinds: expected_rays() of the plan times a learned factor. Renders of a
  // scene with the same technique, max_depth and min_contribution share a factor, whatever their size,
  // samples and camera. The factor starts at 1. It stays in [1/8, 8], because the renders of one client
  // affect the estimates of others.
  double estimate(const Scene& scene, const Plan& plan);
  // Learns from a complete render of the plan that traced `rays`. The first render sets the factor to the
  // ratio of traced to expected rays. A later render moves the factor halfway to its own ratio, because the
  // view changes along an orbit. An image with fewer than 4,096 camera rays moves it proportionally less.
  void learn(const Scene& scene, const Plan& plan, std::uint64_t rays);

 private:
  static constexpr std::size_t kMaxFactors = 1024;  // most recently used ones

  Lru<std::shared_ptr<double>> factors_{kMaxFactors, Clock::duration::max()};
  std::mutex mutex_;  // guards the numbers that factors_ points to
};

}  // namespace orrery
