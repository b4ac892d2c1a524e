#pragma once

#include "core/math/vec3.h"

namespace orrery {

// Light that arrives at a surface point from one point or one direction.
template <class N>
struct Arrival {
  Vec3<N> direction;  // unit, toward the light
  N distance;         // metres to the light; infinite if directional, -1 if no light arrives
  Vec3<N> incident;   // per channel; see LightBatch::incident
};

// Light that arrives from a sampled point of a light.
template <class N>
struct LightSample {
  Arrival<N> arrival;
  N pdf;  // per solid angle; 0 if no ray can hit the light
};

// Radiance of an infinitely distant light in one direction.
template <class N>
struct DistantRadiance {
  Vec3<N> radiance;
  N pdf;  // per solid angle: density of draw() in that direction
};

}  // namespace orrery
