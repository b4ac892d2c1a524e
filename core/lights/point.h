#pragma once

#include "core/lights/arrival.h"
#include "core/lights/attenuation.h"
#include "core/model/light.h"

namespace orrery {

// Point light, uniform in all directions.
template <class N>
struct PointLight {
  Vec3<N> position, intensity;
  Attenuation<N> attenuation;

  static constexpr LightTraits kTraits = {.delta = true};
  static PointLight<double> read(Params& p);

  LightBounds bounds() const {
    return {.centre = position,
            .strength = max_component(intensity),
            .attenuation = {attenuation.c0, attenuation.c1, attenuation.c2}};
  }

  Vec3d max_incident(double distance) const { return intensity * attenuation.at(distance); }

  Arrival<N> arrive(const Vec3<N>& at) const {
    using T = ScalarOf<N>;
    const Vec3<N> toward = position - at;
    const N distance = length(toward);
    return {toward / distance, select(distance > N(T(0)), distance, N(T(-1))),
            intensity * attenuation.at(distance)};
  }
};

}  // namespace orrery
