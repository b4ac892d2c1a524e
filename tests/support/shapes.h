#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/support/rays.h"

// Test data for every registered shape: objects of its type, placements, and rays.
namespace orrery::test {

// Returns the names of all registered shape types.
std::vector<std::string> shape_names();

// Returns objects of a type, about 1 in size, near the origin. Coordinates are small multiples of 1/16, which
// are exact in float. Throws std::out_of_range for a type without objects in shapes.cpp.
const std::vector<Json>& shape_samples(const std::string& type);

// Size and offset of an object.
struct Placement {
  double size;
  Vec3d offset;

  double magnitude() const { return size + max_component(abs(offset)); }
  Json of(const Json& object) const { return placed(object, size, offset); }
};
// Returns placements whose offsets are at most about 1e3 sizes and exact in float, or harder placements for
// double.
std::span<const Placement> float_placements();
std::span<const Placement> double_placements();
template <class T>
std::span<const Placement> placements() {
  return std::is_same_v<T, float> ? float_placements() : double_placements();
}

// Returns rays from outside, from inside and from afar: at random points, along axes, and grazing the
// surface. The smallest grazing angle is 1e-6 radians in double and 2e-4 in float, where directions have
// rounding errors of 6e-8. Directions are unit vectors.
template <class T>
Rays<T> rays_at(const Json& object, const Placement& placement, int count, std::uint64_t seed);

}  // namespace orrery::test
