#pragma once

#include <limits>

#include "core/math/vec3.h"

namespace orrery {

// Within which all radiance of a scene lies, per channel. Nothing is known if `most` is infinite.
struct RadianceRange {
  Vec3d least{0.0}, most{std::numeric_limits<double>::infinity()};

  bool finite() const { return max_component(most) < std::numeric_limits<double>::infinity(); }
  // The most by which `substitute` may be off.
  Vec3d most_off(const Vec3d& substitute) const { return largest(most - substitute, substitute - least); }
};

}  // namespace orrery
