#include "server/scheduler/ray_estimator.h"

#include <algorithm>

#include "core/model/technique.h"
#include "core/params/params.h"
#include "core/plan/cost.h"

namespace orrery {
namespace {

std::string key_of(const Scene& scene, const Plan& plan) {
  return scene.id + " " + plan.technique->name + " " + std::to_string(plan.max_depth) + " " +
         number_text(plan.min_contribution);
}

}  // namespace

double RayEstimator::estimate(const Scene& scene, const Plan& plan) {
  const double expected = expected_rays(scene, plan);
  const auto factor = factors_.find(key_of(scene, plan));
  if (!factor) return expected;
  const std::lock_guard lock(mutex_);
  return **factor * expected;
}

void RayEstimator::learn(const Scene& scene, const Plan& plan, std::uint64_t rays) {
  constexpr double kEnoughCameraRays = 4096, kMaxFactor = 8;
  const double camera_rays = double(plan.width) * plan.height * plan.samples;
  const double weight = std::min(1.0, camera_rays / kEnoughCameraRays);
  const double seen =
      std::clamp(static_cast<double>(rays) / expected_rays(scene, plan), 1 / kMaxFactor, kMaxFactor);
  const std::string nobody;  // factors belong to no client
  const auto added = factors_.add(key_of(scene, plan), nobody, 1,
                                  [&] { return std::make_shared<double>(1 + weight * (seen - 1)); });
  if (!added->known) return;
  const std::lock_guard lock(mutex_);
  *added->value += weight / 2 * (seen - *added->value);
}

}  // namespace orrery
