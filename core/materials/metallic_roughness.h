#pragma once

#include "core/materials/facet_albedo.h"
#include "core/materials/fresnel.h"
#include "core/materials/ggx_albedo.h"
#include "core/materials/lobes.h"
#include "core/materials/metal.h"

namespace orrery {

class MaterialParams;
template <class N>
struct MetallicRoughnessInputs;

// Metallic-roughness material of glTF 2.0 (Khronos, specification, appendix B): GGX microfacets with
// Schlick's approximation over a diffuse base. The specification's formula lets the base scatter light that
// the facets have already mirrored, and loses light scattered between facets. Here, the base receives only
// light that the facets do not reflect, as in Plastic. The lobe of Kulla and Conty restores multiple
// scattering. `strict` selects the specification's formula.
template <class N>
struct MetallicRoughness {
  Vec3<N> f0;              // reflectance along the normal
  Vec3<N> base;            // strict: base reflectance; otherwise factor of left(viewer) * left(light)
  Vec3<N> multiple;        // F_ms of Kulla and Conty; 0 if strict
  N strict;                // 1 or 0
  N alpha;                 // GGX parameter
  GgxAlbedo<N> albedo;     // albedo of facets that mirror all light
  FacetAlbedo<N> grazing;  // albedo of facets that mirror the fraction (1 - cos)^5

  template <class M>
  using Inputs = MetallicRoughnessInputs<M>;
  MaterialTraits traits() const {
    return {.lit = true, .glossy = true, .diffuse = true, .non_diffuse = true};
  }
  double max_albedo() const;
  ReflectionLimits limits() const {
    const double most = max_albedo();
    return {Vec3d(1) + base * strict,
            base + multiple / std::max(1 - albedo.mean, std::numeric_limits<double>::min()) +
                Vec3d(Ggx<double>{alpha}.most()),
            Vec3d(most)};
  }

  N rough() const { return N(ScalarOf<N>(1)); }
  Vec3<N> ambient_reflectance(const N& cosine, Lobes lobes) const {
    const N one(ScalarOf<N>(1));
    const Vec3<N> zero(N(ScalarOf<N>(0))), white(one);
    const Vec3<N> even = left({albedo.mean, f0 * (albedo.mean - grazing.mean) + Vec3<N>(grazing.mean)});
    const auto seen = albedos(cosine);
    const Vec3<N> matt = base * select(strict > N(ScalarOf<N>(0)), white - f0, left(seen) * even);
    return (with_non_diffuse(lobes) ? seen.once + multiple * (one - seen.all) : zero) +
           (with_diffuse(lobes) ? matt : zero);
  }
  Vec3<N> body_transmittance(const MaskOf<N>&, const N&) const { return Vec3<N>(N(ScalarOf<N>(1))); }

  // Single-scattering albedos at one cosine. `all`: facets that mirror all light. `once`: the material's
  // facets.
  struct Albedos {
    N all;
    Vec3<N> once;
  };
  [[gnu::always_inline]] Albedos albedos(const N& cosine) const {
    const N one(ScalarOf<N>(1)), mu = min_first(one, cosine);
    const N all = albedo.at(mu), edge = min_first(all, grazing.at(mu));
    return {all, f0 * (all - edge) + Vec3<N>(edge)};
  }
  // Returns the fraction of light that passes the facets without reflection and reaches the base.
  [[gnu::always_inline]] Vec3<N> left(const Albedos& a) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const Vec3<N> rest = Vec3<N>(one) - a.once - multiple * (one - a.all);
    return {max_first(zero, rest.x), max_first(zero, rest.y), max_first(zero, rest.z)};
  }
  // Returns the probability of sampling a facet. Otherwise, drawn() samples a cosine-weighted direction.
  [[gnu::always_inline]] N facet_chance(const Albedos& a, Lobes lobes) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    if (!with_non_diffuse(lobes)) return zero;
    const N matt = with_diffuse(lobes) ? N(max_component(left(a) * base)) : zero;
    return lobe_chance(max_component(a.once), N(matt + max_component(multiple) * (one - a.all)));
  }

  [[gnu::always_inline]] Scattered<N> scattered(const Vec3<N>& viewer, const Vec3<N>& light, const MaskOf<N>&,
                                                Lobes lobes) const {
    using T = ScalarOf<N>;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N zero(T(0)), one(T(1));
    const auto lit = light.z > zero;
    const N cosine = select(lit, light.z, one);
    const Ggx<N> facets{alpha};
    const auto half = facets.half(viewer, light);
    const N along = min_first(one, N(half.length * T(0.5)));
    const Vec3<N> fresnel(fresnel_schlick(f0.x, along), fresnel_schlick(f0.y, along),
                          fresnel_schlick(f0.z, along));
    const auto seen = albedos(viewer.z), given = albedos(cosine);
    const auto is_strict = strict > zero;
    const Vec3<N> passed_to_base = select(is_strict, Vec3<N>(one) - fresnel, left(seen) * left(given));
    const N spread = (one - seen.all) * (one - given.all) /
                     max_first(N(std::numeric_limits<T>::min()), N(one - albedo.mean));
    const N single = facets.brdf(viewer, light, half.density) * kPi;
    const N chance = facet_chance(seen, lobes);
    const Vec3<N> matt = with_diffuse(lobes) ? base * passed_to_base : Vec3<N>(zero);
    const N facets_count = with_non_diffuse(lobes) ? one : zero;
    return {(matt + multiple * (spread * facets_count) + fresnel * (single * facets_count)) * cosine,
            select(lit, N(chance * facets.pdf(viewer, half.density) + (one - chance) * cosine * (one / kPi)),
                   zero)};
  }

  DrawnDirection<N> drawn(const Vec3<N>& viewer, const MaskOf<N>&, Lobes lobes,
                          const LobeDraw<N>& draw) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const auto [mirrors, u] = draw.choose(facet_chance(albedos(viewer.z), lobes));
    const Vec3<N> facet = Ggx<N>{alpha}.visible_normal(viewer, u, draw.v);
    return {
        select(mirrors, mirrored_about(viewer, facet), cosine_direction(Vec3<N>(zero, zero, one), u, draw.v)),
        MaskOf<N>(false)};
  }
};

// Parameters of a MetallicRoughness material, and the albedos of its facets.
template <class N>
struct MetallicRoughnessInputs {
  static constexpr bool kTabulatesRoughnessOnly = true;
  Vec3<N> base_color, normal_reflectance;
  N metallic, strict, roughness;
  N alpha;
  GgxAlbedo<N> albedo;
  FacetAlbedo<N> grazing;

  void read(MaterialParams& p);
  void tabulate(double roughness);
  MetallicRoughness<N> record() const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const auto is_strict = strict > zero;
    MetallicRoughness<N> found{normal_reflectance * (one - metallic) + base_color * metallic,
                               base_color * (one - metallic),
                               Vec3<N>(zero),
                               strict,
                               alpha,
                               albedo,
                               grazing};
    if (all(is_strict)) return found;
    const auto channel = [&](const N& f0, N& base, N& multiple) {
      const N mean_f0 = f0 + (one - f0) / ScalarOf<N>(21);  // mean of Schlick's approximation
      const N together = multiple_scattering_reflectance(mean_f0, albedo.mean);
      const N left =
          one - (f0 * (albedo.mean - grazing.mean) + grazing.mean) - together * (one - albedo.mean);
      multiple = select(is_strict, zero, together);
      const auto passes = left > zero;
      base = select(is_strict, base, select(passes, N(base / select(passes, left, one)), zero));
    };
    channel(found.f0.x, found.base.x, found.multiple.x);
    channel(found.f0.y, found.base.y, found.multiple.y);
    channel(found.f0.z, found.base.z, found.multiple.z);
    return found;
  }
};

// Reads the parameters of MetallicRoughness other than `strict` into members of the inputs of a material.
void read_metallic_roughness(MaterialParams& p, Vec3d& base_color, Vec3d& normal_reflectance,
                             double& metallic, double& roughness);

}  // namespace orrery
