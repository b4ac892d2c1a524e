#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/rendering/orbit.h"

namespace orrery {

// Error bounds of the frames of an orbit, and the outcome of its budget, if any. The first frame is rendered
// within the budget. Later frames use the settings of the first frame, so that the quality stays constant.
class OrbitBudget {
 public:
  explicit OrbitBudget(int frames) : frames_(static_cast<std::size_t>(frames)) {}

  // Records the next frame of the path. After the first frame, the path continues without a budget. Throws
  // BudgetMissed if the error bound of the frame exceeds the budget and a miss is an error.
  void add(const Scene& scene, const RenderResult& frame, OrbitPath& path);

  // REQUIRES for the functions below: the frame, or the first `frames` frames, were added.
  // Returns {"kind", "rms", "max", "space"}.
  nlohmann::ordered_json bound_json(int frame) const;
  // Returns budget_json() of the first frame with "plan", "frames_met" and "largest_bound", or null without a
  // budget. "plan" is the query of the first frame's plan. "frames_met" is the number of frames whose bound
  // is within the error budget, or null without an error budget. "largest_bound" is the largest RMS bound, or
  // null if the bound of a frame is unknown.
  nlohmann::ordered_json json(int frames) const;

 private:
  struct Frame {
    Bound bound;
    Space space = Space::linear;  // error space of `bound`
  };
  const Frame& at(int frame) const { return frames_[static_cast<std::size_t>(frame)]; }
  bool keeps_error(int frame) const;

  std::vector<Frame> frames_;
  int next_ = 0;
  std::optional<BudgetOutcome> of_first_;
  std::string plan_;  // plan of the later frames, as a query
};

}  // namespace orrery
