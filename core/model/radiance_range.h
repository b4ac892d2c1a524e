#pragma once

#include <limits>

#include "core/math/vec3.h"

namespace orrery {

// Range of all radiance in a scene, per channel. `most` is infinite if no bound is known.
struct RadianceRange {
  Vec3d least{0.0}, most{std::numeric_limits<double>::infinity()};

  bool finite() const { return max_component(most) < std::numeric_limits<double>::infinity(); }
  // Returns the largest difference between `substitute` and a radiance in the range.
  Vec3d max_deviation(const Vec3d& substitute) const {
    return largest(most - substitute, substitute - least);
  }
};

}  // namespace orrery
