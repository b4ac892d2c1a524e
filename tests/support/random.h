#pragma once

#include <cmath>
#include <numbers>

#include "core/stability/split_mix.h"

namespace orrery::test {

class Random : public SplitMix {
 public:
  using SplitMix::SplitMix;

  // Returns a number from `low` to `high` whose logarithm is uniformly distributed. REQUIRES: 0 < low <=
  // high.
  double magnitude(double low, double high) { return low * std::pow(high / low, unit()); }

  Vec3d direction() {  // uniform over the sphere
    const double z = between(-1, 1), angle = between(0, 2 * std::numbers::pi);
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }
  Vec3d direction_above(const Vec3d& normal) {  // uniform over the hemisphere about `normal`
    const Vec3d d = direction();
    return dot(d, normal) < 0 ? -d : d;
  }
};

// Returns a unit vector perpendicular to `v`.
inline Vec3d perpendicular(const Vec3d& v) {
  const Vec3d other = std::abs(v.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  return safe_normalize(cross(v, other));
}

}  // namespace orrery::test
