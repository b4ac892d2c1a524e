#pragma once

#include <numbers>

#include "core/materials/fresnel.h"
#include "core/materials/ggx_albedo.h"
#include "core/materials/microfacet.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

class MaterialParams;
template <class N>
struct MetalInputs;

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

  template <class M>
  using Inputs = MetalInputs<M>;
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
template <class N>
N multiple_scattering_reflectance(const N& mean_reflectance, const N& mean_albedo) {
  const N one(ScalarOf<N>(1));
  return mean_reflectance * mean_reflectance * mean_albedo / (one - mean_reflectance * (one - mean_albedo));
}

// Parameters of a Metal material, and the albedo of its facets.
template <class N>
struct MetalInputs {
  static constexpr bool kTabulatesRoughnessOnly = true;
  Vec3<N> n, k;
  N roughness;
  N alpha;
  GgxAlbedo<N> albedo;

  void read(MaterialParams& p);
  void tabulate(double roughness);
  Metal<N> record() const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    Metal<N> metal{n, k, {}, alpha, albedo, {}};
    metal.f0 = metal.reflectance(one);
    const auto rough = alpha > zero && albedo.mean < one;
    if (!any(rough)) return metal;
    const auto scale = [&](const N& mean_f) {
      const N lost = select(rough, N(one - albedo.mean), one);
      return select(rough, N(multiple_scattering_reflectance(mean_f, albedo.mean) / lost), zero);
    };
    metal.multiple_scale = {scale(mean_reflectance(n.x, k.x)), scale(mean_reflectance(n.y, k.y)),
                            scale(mean_reflectance(n.z, k.z))};
    return metal;
  }

 private:
  // Returns the cosine-weighted mean reflectance over the hemisphere, the integral of 2 mu F(mu), by the
  // midpoint rule. Lanes evaluate it for each surface and use fewer steps.
  static N mean_reflectance(const N& of_n, const N& of_k) {
    using T = ScalarOf<N>;
    constexpr int kSteps = std::is_same_v<N, double> ? 256 : 16;
    N sum(T(0));
    for (int i = 0; i < kSteps; ++i) {
      const N mu(T((i + 0.5) / kSteps));
      sum = sum + T(2) * mu * fresnel_conductor(of_n, of_k, mu);
    }
    return sum / T(kSteps);
  }
};

}  // namespace orrery
