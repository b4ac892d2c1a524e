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

// What arrives from a point of a light that was drawn: see LightBatch.
template <class N>
struct Drawn {
  Arrival<N> arrival;
  N pdf;  // per solid angle; 0 of a light that no ray can hit
};

// What a direction sees of a light that is infinitely far away.
template <class N>
struct Seen {
  Vec3<N> radiance;
  N pdf;  // of Drawn, in that direction
};

}  // namespace orrery
