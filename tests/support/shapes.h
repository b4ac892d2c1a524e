#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/support/rays.h"

// What every registered shape is tested on: objects of its type, where they are put, and rays at them.
namespace orrery::test {

// Names of all registered shape types.
std::vector<std::string> shape_names();

// Objects of a type, about 1 in size, near the origin; their coordinates are small multiples of 1/16, so that
// they are exact in float. Throws std::out_of_range for a type without any: add them in shapes.cpp.
const std::vector<Json>& shape_samples(const std::string& type);

// A size and a place.
struct Placement {
  double size;
  Vec3d offset;

  double magnitude() const { return size + max_component(abs(offset)); }
  Json of(const Json& object) const { return placed(object, size, offset); }
};
// Placements that float resolves: magnitude over size at most 1e3, all exact. And what double must take on.
std::span<const Placement> float_placements();
std::span<const Placement> double_placements();
template <class T>
std::span<const Placement> placements() {
  return std::is_same_v<T, float> ? float_placements() : double_placements();
}

// Rays from outside, from inside and from afar, at random points, along axes, and grazing the surface: at
// angles down to 1e-6 in double and 2e-4 in float, where a direction itself is known to 6e-8. Unit
// directions.
template <class T>
Rays<T> rays_at(const Json& object, const Placement& placement, int count, std::uint64_t seed);

}  // namespace orrery::test
