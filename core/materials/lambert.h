#pragma once

#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

class MaterialParams;

// Lambertian reflection: the reflected radiance is the same in all directions (Lambert, Photometria, 1760).
template <class N>
struct Lambert {
  Vec3<N> reflectance;

  template <class M>
  using Inputs = Lambert<M>;
  void read(MaterialParams& p);
  Lambert record() const { return *this; }

  MaterialTraits traits() const { return {.lit = true, .diffuse = true}; }
  ReflectionLimits limits() const { return {reflectance, reflectance, reflectance}; }

  [[gnu::always_inline]] Vec3<N> pi_brdf(const N&, const N&, const N&) const { return reflectance; }
};

}  // namespace orrery
