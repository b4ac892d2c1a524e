#pragma once

#include "core/materials/facet_albedo.h"
#include "core/materials/fresnel.h"
#include "core/materials/lobes.h"

namespace orrery {

class MaterialParams;
template <class N>
struct PlasticInputs;

// Diffuse base under a clear coat, smooth or of microfacets. The base scatters the light that the coat
// transmits on the way in and out (Kelemen, Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF
// Model with Importance Sampling", Eurographics 2001). The base also scatters the light that the coat
// reflects back to the base. A coated white base therefore has albedo 1 at any roughness.
template <class N>
struct Plastic {
  Vec3<N> base;  // factor of (1 - mirrored(N.V)) * (1 - mirrored(N.L))
  N ior;
  N alpha;                // GGX parameter; 0: smooth
  FacetAlbedo<N> mirror;  // albedo of a rough coat
  N mean;                 // reflectance of the coat for uniform light

  template <class M>
  using Inputs = PlasticInputs<M>;
  MaterialTraits traits() const {
    return {.lit = true, .mirrors = !(alpha > 0), .glossy = true, .diffuse = true, .non_diffuse = true};
  }
  double mirrored_share() const { return alpha > 0 ? 0 : fresnel(1); }
  ReflectionLimits limits() const {
    if (alpha > 0) return {Vec3d(1), base + Vec3d(Ggx<double>{alpha}.most()), Vec3d(1)};
    return {base * (1 - mean), base, Vec3d(1), true};
  }

  N rough() const { return N(ScalarOf<N>(1)); }
  // Returns the fraction of ambient light that is reflected, without the mirror reflection of a smooth coat.
  Vec3<N> ambient_reflectance(const N& cosine, Lobes lobes) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1)), mirrors = mirrored(cosine);
    return (with_diffuse(lobes) ? base * ((one - mirrors) * (one - mean)) : Vec3<N>(zero)) +
           Vec3<N>(with_non_diffuse(lobes) ? select(alpha > zero, mirrors, zero) : zero);
  }
  Vec3<N> body_transmittance(const MaskOf<N>&, const N&) const { return Vec3<N>(N(ScalarOf<N>(1))); }

  [[gnu::always_inline]] N fresnel(const N& cosine) const {
    const N one(ScalarOf<N>(1));
    return split_dielectric(N(one / ior), min_first(one, max_first(N(ScalarOf<N>(0)), cosine))).reflectance;
  }
  // Returns the fraction of light at this cosine that the coat mirrors.
  [[gnu::always_inline]] N mirrored(const N& cosine) const {
    const auto facets = alpha > N(ScalarOf<N>(0));
    if (all(facets)) return mirror.at(min_first(N(ScalarOf<N>(1)), cosine));
    if (!any(facets)) return fresnel(cosine);
    return select(facets, mirror.at(min_first(N(ScalarOf<N>(1)), cosine)), fresnel(cosine));
  }
  // Returns the probability of sampling the coat if it mirrors the fraction `mirrors`.
  [[gnu::always_inline]] N coat_chance(const N& mirrors, Lobes lobes) const {
    if (lobes != Lobes::all) return N(ScalarOf<N>(with_non_diffuse(lobes) ? 1 : 0));
    return lobe_chance(mirrors, N((ScalarOf<N>(1) - mirrors) * max_component(base)));
  }

  // Evaluates all lobes except the mirror reflection of a smooth coat.
  [[gnu::always_inline]] Scattered<N> scattered(const Vec3<N>& viewer, const Vec3<N>& light, const MaskOf<N>&,
                                                Lobes lobes) const {
    using T = ScalarOf<N>;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N zero(T(0)), one(T(1));
    const N mirrors = mirrored(viewer.z), chance = coat_chance(mirrors, lobes);
    const auto lit = light.z > zero;
    const N cosine = select(lit, light.z, one);
    Scattered<N> found{Vec3<N>(zero), (one - chance) * cosine * (one / kPi)};
    if (with_diffuse(lobes)) found.pi_bsdf_cos = base * ((one - mirrors) * (one - mirrored(cosine)) * cosine);
    const auto facets = alpha > zero;
    if (with_non_diffuse(lobes) && any(facets)) {
      const Ggx<N> coat{select(facets, alpha, one)};
      const auto half = coat.half(viewer, light);
      const N single = fresnel(half.length * T(0.5)) * coat.brdf(viewer, light, half.density) * cosine * kPi;
      found.pi_bsdf_cos = found.pi_bsdf_cos + Vec3<N>(select(facets && lit, single, zero));
      found.pdf = found.pdf + select(facets && lit, N(chance * coat.pdf(viewer, half.density)), zero);
    }
    found.pdf = select(lit, found.pdf, zero);
    return found;
  }

  // Samples all lobes except the mirror reflection of a smooth coat, which PlasticKernel::sample() samples.
  DrawnDirection<N> drawn(const Vec3<N>& viewer, const MaskOf<N>&, Lobes lobes,
                          const LobeDraw<N>& draw) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const auto facets = alpha > zero;
    const N chance = select(facets, coat_chance(mirrored(viewer.z), lobes), zero);
    const auto [coat, u] = draw.choose(chance);
    const Vec3<N> facet = Ggx<N>{select(facets, alpha, one)}.visible_normal(viewer, u, draw.v);
    return {
        select(coat, mirrored_about(viewer, facet), cosine_direction(Vec3<N>(zero, zero, one), u, draw.v)),
        MaskOf<N>(false)};
  }
};

// Parameters of a Plastic material, and the albedos of its coat. The internal reflectance of the coat for
// diffuse light is 1 - (1 - E) / n^2, where E is the coat's mean reflectance from outside.
template <class N>
struct PlasticInputs {
  Vec3<N> reflectance;
  N ior, roughness;
  N alpha;
  FacetAlbedo<N> mirror;
  N mean;

  void read(MaterialParams& p);
  void tabulate(double roughness);
  Plastic<N> record() const {
    const N one(ScalarOf<N>(1)), leaves = (one - mean) / (ior * ior);
    const auto base = [&](const N& rho) -> N {
      return rho * leaves / (one - rho * (one - leaves)) / (one - mean);
    };
    return {{base(reflectance.x), base(reflectance.y), base(reflectance.z)}, ior, alpha, mirror, mean};
  }
};

}  // namespace orrery
