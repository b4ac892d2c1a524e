#pragma once

#include <optional>
#include <vector>

#include "tests/exact/integers.h"

namespace orrery::exact {

// A ray from origin / w, in the scene's units, toward `direction`, of any length. Positions along it are
// origin / w + t direction / w.
struct Ray {
  IVec origin;
  Integer w;  // > 0
  IVec direction;
};

// All lengths and positions in the scene's units; normals and axes of any length.
struct Shape {
  enum class Kind { sphere, plane, triangle, box, disk, cylinder, infinite_cylinder } kind;
  IVec a, b, c;  // centre | point, normal | corners | min, max | centre, normal | base, top | point, axis
  Integer radius = 0;  // of sphere, disk and cylinders
  double reach = 0;    // largest coordinate, metres: what rounding is relative to
};

// The first intersection of the ray, ahead of its origin, with the shape's surface, borders included. None if
// the ray runs within a flat surface.
std::optional<Root> nearest_root(const Shape& shape, const Ray& ray);

}  // namespace orrery::exact
