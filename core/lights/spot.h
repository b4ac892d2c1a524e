#pragma once

#include "core/lights/arrival.h"
#include "core/lights/attenuation.h"
#include "core/model/light.h"

namespace orrery {

// Spot light: full intensity inside the inner cone, 0 outside the outer cone. Between the cones, the
// intensity is a smooth step in the cosine.
template <class N>
struct Spot {
  Vec3<N> position, direction, intensity;
  Attenuation<N> attenuation;
  N cos_inner, cos_outer, cos_range;  // cos_range = cos_inner - cos_outer

  static constexpr LightTraits kTraits = {.delta = true};
  static Spot<double> read(Params& p);

  RoundingLimit rounding() const;

  // Assumes the full intensity in every direction.
  LightBounds bounds() const {
    return {.centre = position,
            .strength = max_component(intensity),
            .attenuation = {attenuation.c0, attenuation.c1, attenuation.c2}};
  }

  Vec3d max_incident(double distance) const { return intensity * attenuation.at(distance); }

  Arrival<N> arrive(const Vec3<N>& at) const {
    using T = ScalarOf<N>;
    const N zero(T(0));
    const Vec3<N> toward = position - at;
    const N distance = length(toward);
    const Vec3<N> to_light = toward / distance;
    const N beam = cone(N(-dot(to_light, direction)));
    return {to_light, select(distance > zero && beam > zero, distance, N(T(-1))),
            intensity * (attenuation.at(distance) * beam)};
  }

  // Returns the fraction of the intensity at a cosine to the beam axis. If both angles are equal, the
  // quotient is infinite or NaN. The result is then 1 up to and including that angle, and 0 beyond.
  N cone(const N& cosine) const {
    using T = ScalarOf<N>;
    const N x = (cosine - cos_outer) / cos_range;
    const N unit = max_first(N(T(0)), min_first(N(T(1)), x));
    return select(cosine >= cos_inner, N(T(1)), N(unit * unit * (T(3) - T(2) * unit)));
  }
};

}  // namespace orrery
