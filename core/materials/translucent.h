#pragma once

#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

class MaterialParams;
template <class N>
struct TranslucentInputs;

// Thin sheet, such as paper or a leaf, with Lambertian scattering on both sides. Reflection is a diffuse
// lobe. Transmission is a non-diffuse lobe.
template <class N>
struct Translucent {
  Vec3<N> reflectance, transmittance;
  N through;  // probability of sampling a transmitted direction, with Lobes::all

  template <class M>
  using Inputs = TranslucentInputs<M>;
  MaterialTraits traits() const {
    return {.lit = true, .transmits = true, .diffuse = true, .non_diffuse = true};
  }
  ReflectionLimits limits() const {
    const Vec3d sum = reflectance + transmittance;
    return {sum, sum, sum};
  }
};

// Parameters of a Translucent material.
template <class N>
struct TranslucentInputs {
  Vec3<N> reflectance, transmittance;

  void read(MaterialParams& p);
  Translucent<N> record() const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1)), through = max_component(transmittance);
    const N all = max_component(reflectance) + through;
    return {reflectance, transmittance, select(all > zero, N(through / select(all > zero, all, one)), zero)};
  }
};

}  // namespace orrery
