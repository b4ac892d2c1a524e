#pragma once

#include "core/math/vec3.h"

namespace orrery {

// What arrives at a surface point from a light without extent.
template <class N>
struct Arrival {
  Vec3<N> direction;  // unit, toward the light
  N distance;         // metres to it; infinite if it is directional, -1 where it sends nothing
  Vec3<N> incident;   // per channel
};

}  // namespace orrery
