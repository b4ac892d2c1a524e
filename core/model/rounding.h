#pragma once

#include <limits>
#include <string>

namespace orrery {

// How fine the numbers of a render must be for one thing to look right.
struct RoundingLimit {
  // Largest distance between 1 and the next number of the type.
  double epsilon = std::numeric_limits<double>::infinity();
  std::string reason;  // what it is about the thing: "its beam fades within 0.05 degrees"
};

}  // namespace orrery
