#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "server/app/lru.h"

namespace orrery {

// Expects how many rays renders trace, and learns from what they traced. Safe from any thread.
class RayEstimator {
 public:
  // Rays, of all kinds: expected_rays() of the plan, times the factor learned from renders of that scene by
  // the same technique, depth and least contribution, whatever their size, samples and camera; 1 before the
  // first, and never beyond 1/8 and 8: a client chooses what others learn from.
  double estimate(const Scene& scene, const Plan& plan);
  // A whole picture was rendered by the plan and traced so many rays. The factor moves to the one seen, later
  // half the way: orbits change what is seen, and so the truth. Of a picture of fewer than 4,096 camera rays
  // it moves their share of that.
  void learn(const Scene& scene, const Plan& plan, std::uint64_t rays);

 private:
  static constexpr std::size_t kMostFactors = 1024;  // kept, those used last

  Lru<std::shared_ptr<double>> factors_{kMostFactors, Clock::duration::max()};
  std::mutex mutex_;  // guards the numbers that factors_ points to
};

}  // namespace orrery
