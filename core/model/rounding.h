#pragma once

#include <limits>
#include <string>

namespace orrery {

// Number precision that one feature of a scene requires.
struct RoundingLimit {
  // Largest acceptable distance between 1 and the next number of the type.
  double epsilon = std::numeric_limits<double>::infinity();
  std::string reason;  // property of the feature: "its beam fades within 0.05 degrees"
};

}  // namespace orrery
