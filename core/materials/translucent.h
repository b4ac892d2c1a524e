#pragma once

#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

// Thin sheet, such as paper or a leaf, with Lambertian scattering on both sides. Reflection is a diffuse
// lobe. Transmission is a non-diffuse lobe.
template <class N>
struct Translucent {
  Vec3<N> reflectance, transmittance;
  N through;  // probability of sampling a transmitted direction, with Lobes::all

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
