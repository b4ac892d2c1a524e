#pragma once

#include <stop_token>

#include "core/model/plan.h"
#include "core/prepare/prepared_scene.h"

namespace orrery {

// A plan in which nothing is left open: the only thing that renders.
class SettledPlan {
 public:
  const Plan& operator*() const { return plan_; }
  const Plan* operator->() const { return &plan_; }
  double settle_ms() const { return settle_ms_; }  // that the decision took; 0 if it was known

  // One that traces weaker rays, too, or fewer.
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

// If the plan leaves the accelerator open: takes the one whose counted work on some tiles of the picture
// costs least, and says so in the plan's decisions. Once for a scene and number type; later plans follow, so
// that frames of one scene do not change it. Throws Cancelled once `stop` is requested.
SettledPlan settle(const PreparedScene& scene, Plan plan, std::stop_token stop = {});

}  // namespace orrery
