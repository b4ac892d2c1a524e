#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/rendering/orbit.h"

namespace orrery {

// Outcome of the budget of an orbit, if any. The first frame is rendered
// within the budget. Later frames use the settings of the first frame, so that the quality stays constant.
class OrbitBudget {
 public:
  explicit OrbitBudget(int frames) : bounds_(static_cast<std::size_t>(frames)) {}

  // Records the next frame of the path. After the first frame, the path continues without a budget. Throws
  // BudgetMissed if the error bound of the frame exceeds the budget and a miss is an error.
  void add(const Scene& scene, const RenderResult& frame, OrbitPath& path);

  // Returns budget_json() of the first frame with "plan", "frames_met" and "largest_bound", or null without a
  // budget. "plan" is the query of the first frame's plan. "frames_met" is the number of frames whose bound
  // is within the error budget, or null without an error budget. "largest_bound" is the largest RMS bound, or
  // null if the bound of a frame is unknown. REQUIRES: the first `frames` frames were added.
  nlohmann::ordered_json json(int frames) const;

 private:
  const Bound& at(int frame) const { return bounds_[static_cast<std::size_t>(frame)]; }
  bool keeps_error(int frame) const;

  std::vector<Bound> bounds_;  // by frame
  int next_ = 0;
  std::optional<BudgetOutcome> of_first_;
  std::string plan_;  // plan of the later frames, as a query
};

}  // namespace orrery
