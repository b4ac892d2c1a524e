#pragma once

#include <cmath>
#include <cstdint>

#include "core/math/elementary.h"
#include "core/math/vec3.h"

namespace orrery {

// Random number generator with the same numbers on every machine (SplitMix64: Steele, Lea, Flood, "Fast
// splittable pseudorandom number generators", 2014). For stability rows and tests; renders use Draws.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // in [0, 1)
  double between(double low, double high) { return low + (high - low) * unit(); }
  // Returns an integer in [0, count).
  int below(int count) { return static_cast<int>(bits() % static_cast<std::uint64_t>(count)); }
  Vec3d in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

 private:
  std::uint64_t state_;
};

// Returns a unit vector, uniform on the sphere, computed with portable operations only.
inline Vec3d direction_from(SplitMix& random) {
  const double z = random.between(-1, 1), across = std::sqrt(1 - z * z);
  const auto [sine, cosine] = sine_cosine_turns(random.unit());
  return {across * cosine, across * sine, z};
}
// Returns a unit vector, uniform on the hemisphere around `normal`.
inline Vec3d direction_above(SplitMix& random, const Vec3d& normal) {
  const Vec3d d = direction_from(random);
  return dot(d, normal) < 0 ? -d : d;
}

}  // namespace orrery
