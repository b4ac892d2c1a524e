#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/math/vec3.h"

namespace orrery::test {

// A stream of random numbers, the same on every machine (SplitMix64: Steele, Lea, Flood, "Fast splittable
// pseudorandom number generators", 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // in [0, 1)
  double between(double low, double high) { return low + (high - low) * unit(); }
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  // Every power of ten between the two is as likely as any other.
  double magnitude(double low, double high) { return low * std::pow(high / low, unit()); }

  Vec3d direction() {  // uniform over the sphere
    const double z = between(-1, 1), angle = between(0, 2 * std::numbers::pi);
    const double across = std::sqrt(1 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }
  Vec3d direction_above(const Vec3d& normal) {  // uniform over the half sphere about `normal`
    const Vec3d d = direction();
    return dot(d, normal) < 0 ? -d : d;
  }
  Vec3d in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

 private:
  std::uint64_t state_;
};

// Some unit vector at right angles to `v`.
inline Vec3d perpendicular(const Vec3d& v) {
  const Vec3d other = std::abs(v.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  return safe_normalize(cross(v, other));
}

}  // namespace orrery::test
