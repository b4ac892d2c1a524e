#pragma once

#include <limits>
#include <string>

namespace orrery {

// Number precision that one feature of a scene requires.
struct RoundingLimit {
  // Largest acceptable machine epsilon of the number type.
  double epsilon = std::numeric_limits<double>::infinity();
  std::string reason;  // clause about the feature, such as "its beam fades within 0.05 degrees"
};

}  // namespace orrery
