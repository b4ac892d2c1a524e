#pragma once

#include <optional>
#include <vector>

#include "tests/exact/integers.h"

namespace orrery::exact {

// Ray from origin / w, in the scene's units, toward `direction`, of any length. Points along the ray are
// origin / w + t direction / w.
struct Ray {
  IVec origin;
  Integer w;  // > 0
  IVec direction;
};

// Shape with lengths and positions in the scene's units. Normals and axes may have any length.
struct Shape {
  enum class Kind { sphere, plane, triangle, box, disk, cylinder, infinite_cylinder } kind;
  // By kind: centre | point, normal | corners | min, max | centre, normal | base, top | point, axis.
  IVec a, b, c;
  Integer radius = 0;  // for sphere, disk and cylinders
  double reach = 0;    // largest coordinate in metres, which scales rounding errors
};

// Returns the first intersection beyond the ray's origin with the surface of the shape, including its
// borders. Returns nullopt if the ray misses or lies in a flat surface.
std::optional<Root> nearest_root(const Shape& shape, const Ray& ray);

}  // namespace orrery::exact
