#pragma once

#include <stop_token>

#include "core/model/plan.h"
#include "core/prepare/prepared_scene.h"

// Choices by measurement. Traces tiles of the image to choose the accelerator and to train the
// occluder network.
//
// Threads: settle() and staged_world() are thread-safe. Each result is computed once per scene and number
// type while other threads wait.
// Errors: Cancelled, std::bad_alloc, and the errors of AcceleratorType.
namespace orrery {

// Plan without open choices. Only settled plans are rendered.
class SettledPlan {
 public:
  const Plan& operator*() const { return plan_; }
  const Plan* operator->() const { return &plan_; }
  double settle_ms() const { return settle_ms_; }  // time of the choice; 0 if cached or not open

  // Returns a copy with min_contribution set to `weight`.
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

// Chooses the accelerator if the plan leaves the choice open. Candidates are the planned accelerator, `boxes`
// for up to 10,000 primitives, and `list` for up to 64. Their costs are estimated from the operations counted
// on three tiles of the image. The cheapest candidate replaces the planned accelerator if its cost is below
// 85 % of the planned cost. Records the choice in the plan's decisions. Chooses once per scene and number
// type, so that all frames of a scene use the same accelerator. Thread-safe. Throws Cancelled if `stop` is
// requested, and the errors of AcceleratorType.
SettledPlan settle(const PreparedScene& scene, Plan plan, std::stop_token stop = {});

}  // namespace orrery
