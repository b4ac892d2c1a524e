#include "server/app/ray_estimator.h"

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
  const double seen = static_cast<double>(rays) / expected_rays(scene, plan);
  const auto [factor, known] =
      factors_.add(key_of(scene, plan), 1, [&] { return std::make_shared<double>(seen); });
  if (!known) return;
  const std::lock_guard lock(mutex_);
  *factor += (seen - *factor) / 2;
}

}  // namespace orrery
