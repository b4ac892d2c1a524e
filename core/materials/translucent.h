#pragma once

#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

// A thin sheet, such as paper or a leaf, that scatters light evenly on both sides: Lambert's law on each.
// What leaves on the side it came from is diffuse, what goes through is not.
template <class N>
struct Translucent {
  Vec3<N> reflectance, transmittance;
  N through;  // share of draws that leave on the far side

  static Translucent<double> read(Params& p);
  MaterialTraits traits() const {
    return {.lit = true, .transmits = true, .diffuse = true, .non_diffuse = true};
  }
  ReflectionLimits limits() const {
    const Vec3d sum = reflectance + transmittance;
    return {sum, sum, sum};
  }
};

}  // namespace orrery
