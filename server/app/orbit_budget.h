#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/app/orbit.h"

namespace orrery {

// How far the frames of an orbit may be off, and its budget, if there is one: the first frame is made within
// it, and all others of what that one took, so that quality does not change from frame to frame.
class OrbitBudget {
 public:
  explicit OrbitBudget(int frames) : frames_(static_cast<std::size_t>(frames)) {}

  // Takes the next frame of the path. After the first one it goes on without a budget. Throws BudgetMissed
  // where the frame may be farther off than is asked and that is to be an error.
  void add(const Scene& scene, const RenderResult& frame, OrbitPath& path);

  // REQUIRES of all below: the frame, or so many, were added.
  // {"kind", "rms", "max", "space"}.
  nlohmann::ordered_json bound_json(int frame) const;
  // What budget_json() tells of the first frame, and {"plan", "frames_met", "largest_bound"}: the query of
  // that plan, frames whose bound is at most the error asked, null if none was, and the largest RMS of any
  // bound, null if one has none. Null without a budget.
  nlohmann::ordered_json json(int frames) const;

 private:
  struct Frame {
    Bound bound;
    Space space = Space::linear;  // that it is in
  };
  const Frame& at(int frame) const { return frames_[static_cast<std::size_t>(frame)]; }
  bool keeps_error(int frame) const;

  std::vector<Frame> frames_;
  int next_ = 0;
  std::optional<BudgetOutcome> of_first_;
  std::string plan_;  // of all others, as a query
};

}  // namespace orrery
