#pragma once

#include <numbers>

#include "core/materials/fresnel.h"
#include "core/materials/ggx_albedo.h"
#include "core/materials/microfacet.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

// Metal of microfacets, coloured by Fresnel's equations. Light scattered between facets is restored by the
// lobe of Kulla and Conty ("Revisiting Physically Based Shading at Imageworks", SIGGRAPH course, 2017). A
// metal that mirrors all light therefore has albedo 1 at any roughness. With alpha 0, the metal is a smooth
// mirror.
template <class N>
struct Metal {
  Vec3<N> n, k;  // index of refraction and extinction coefficient
  Vec3<N> f0;    // reflectance along the normal
  N alpha;       // GGX parameter; 0: mirror
  GgxAlbedo<N> albedo;
  Vec3<N> multiple_scale;  // F_ms / (1 - mean albedo)

  static Metal<double> read(Params& p);
  MaterialTraits traits() const {
    return {.lit = alpha > 0, .mirrors = !(alpha > 0), .glossy = alpha > 0, .non_diffuse = true};
  }
  double mirrored_share() const { return alpha > 0 ? 0 : max_component(f0); }
  ReflectionLimits limits() const {
    if (!(alpha > 0)) return {Vec3d(0), Vec3d(0), Vec3d(1), true};
    return {f0, Vec3d(Ggx<double>{alpha}.most()) + multiple_scale, Vec3d(1), false};
  }

  [[gnu::always_inline]] Vec3<N> reflectance(const N& cosine) const {
    return {fresnel_conductor(n.x, k.x, cosine), fresnel_conductor(n.y, k.y, cosine),
            fresnel_conductor(n.z, k.z, cosine)};
  }

  // Result of scattered(): see MaterialKernel::evaluate(). Directions are in the frame of Ggx. Undefined in
  // lanes where alpha, N.V or N.L is 0 or negative.
  struct Scattered {
    Vec3<N> pi_bsdf_cos;
    N pdf;
  };
  [[gnu::always_inline]] Scattered scattered(const Vec3<N>& viewer, const Vec3<N>& light) const {
    using T = ScalarOf<N>;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N one(T(1));
    const Ggx<N> facets{alpha};
    const auto half = facets.half(viewer, light);
    const N missing_viewer = multiple_share(viewer.z), missing_light = multiple_share(light.z);
    const N single = facets.brdf(viewer, light, half.density) * light.z * kPi;
    const N multiple = missing_viewer * missing_light * light.z;
    return {
        reflectance(min_first(one, N(half.length * T(0.5)))) * single + multiple_scale * multiple,
        (one - missing_viewer) * facets.pdf(viewer, half.density) + missing_viewer * light.z * (one / kPi)};
  }

  // Returns the fraction of light at this cosine that is scattered between facets. MetalKernel::sample() uses
  // this fraction as the probability of cosine-weighted sampling. This choice bounds the sample weight
  // without clamping the probability.
  [[gnu::always_inline]] N multiple_share(const N& cosine) const {
    const N one(ScalarOf<N>(1));
    return one - albedo.at(min_first(one, cosine));
  }
};

// Returns F_ms of Kulla and Conty, the sum over all bounces: F^2 E / (1 - F (1 - E)). F is the mean
// reflectance of the metal, E the mean albedo of facets that mirror all light.
inline double multiple_scattering_reflectance(double mean_reflectance, double mean_albedo) {
  return mean_reflectance * mean_reflectance * mean_albedo / (1 - mean_reflectance * (1 - mean_albedo));
}

}  // namespace orrery
