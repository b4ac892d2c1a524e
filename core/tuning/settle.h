#pragma once

#include <stop_token>

#include "core/model/plan.h"
#include "core/prepare/prepared_scene.h"

namespace orrery {

// Plan without open choices. Only settled plans are rendered.
class SettledPlan {
 public:
  const Plan& operator*() const { return plan_; }
  const Plan* operator->() const { return &plan_; }
  double settle_ms() const { return settle_ms_; }  // time of the decision; 0 if it was cached

  // Returns a copy with another minimum contribution of traced rays.
  SettledPlan with_min_contribution(double weight) const {
    SettledPlan other = *this;
    other.plan_.min_contribution = weight;
    return other;
  }

 private:
  friend SettledPlan settle(const PreparedScene& scene, Plan plan, std::stop_token stop);
  SettledPlan(Plan plan, double settle_ms) : plan_(std::move(plan)), settle_ms_(settle_ms) {}
  Plan plan_;
  double settle_ms_;
};

// Chooses the accelerator if the plan leaves it open. Estimates costs from the operations counted on some
// tiles of the image. The cheapest accelerator replaces the planned one if it costs less than 85 % of it.
// Records the choice in the plan's decisions. Decides once per scene and number type, so that all frames of a
// scene use the same accelerator. Thread-safe. Throws Cancelled if `stop` is requested, and the errors of
// AcceleratorType.
SettledPlan settle(const PreparedScene& scene, Plan plan, std::stop_token stop = {});

}  // namespace orrery
