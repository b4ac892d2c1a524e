#pragma once

#include "core/materials/fresnel.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

class MaterialParams;
template <class N>
struct ReflectiveInputs;

// Smooth metal mirror, coloured by Fresnel reflection.
template <class N>
struct Reflective {
  Vec3<N> n, k;  // index of refraction and extinction coefficient
  Vec3<N> f0;    // reflectance along the normal
  N exact;       // 1: Fresnel's equations, 0: Schlick's approximation

  template <class M>
  using Inputs = ReflectiveInputs<M>;
  MaterialTraits traits() const { return {.mirrors = true, .non_diffuse = true}; }
  double mirrored_share() const { return max_component(f0); }
  ReflectionLimits limits() const { return {Vec3d(0), Vec3d(0), Vec3d(1), true}; }

  [[gnu::always_inline]] Vec3<N> reflectance(const N& cosine) const {
    const auto equations = exact > N(ScalarOf<N>(0));
    Vec3<N> r(fresnel_schlick(f0.x, cosine), fresnel_schlick(f0.y, cosine), fresnel_schlick(f0.z, cosine));
    if (any(equations))
      r = {select(equations, fresnel_conductor(n.x, k.x, cosine), r.x),
           select(equations, fresnel_conductor(n.y, k.y, cosine), r.y),
           select(equations, fresnel_conductor(n.z, k.z, cosine), r.z)};
    return r;
  }
};

// Parameters of a Reflective material.
template <class N>
struct ReflectiveInputs {
  Vec3<N> n, k;
  N exact;

  void read(MaterialParams& p);
  Reflective<N> record() const {
    const Vec3<N> f0(normal_reflectance(n.x, k.x), normal_reflectance(n.y, k.y),
                     normal_reflectance(n.z, k.z));
    return {n, k, f0, exact};
  }
};

}  // namespace orrery
