#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "core/math/bounds.h"

namespace orrery {

// Space that contains all surfaces of a scene: a box and infinite planes. By default, surfaces may be
// anywhere.
struct OccupiedSpace {
  struct Plane {
    Vec3d point, normal;
  };
  Boundsd box = Boundsd::everything();
  std::vector<Plane> planes;

  // Returns true only if the ray misses every surface.
  bool is_missed(const Vec3d& origin, const Vec3d& direction) const {
    if (box.bounded() &&
        enters(BoxRay<double>(origin, direction), box.lo, box.hi, std::numeric_limits<double>::max()))
      return false;
    const bool somewhere = box.bounded() || box.lo.x > box.hi.x;  // bounded or empty
    return somewhere && std::none_of(planes.begin(), planes.end(), [&](const Plane& plane) {
             return dot(origin - plane.point, plane.normal) * dot(direction, plane.normal) <= 0;
           });
  }
};

}  // namespace orrery
