#pragma once

#include "core/materials/facet_albedo.h"
#include "core/materials/fresnel.h"
#include "core/materials/lobes.h"
#include "core/materials/refractive.h"

namespace orrery {

class MaterialParams;
template <class N>
struct GlassInputs;

// Glass of microfacets that mirror and refract (Walter, Marschner, Li, Torrance, "Microfacet Models for
// Refraction through Rough Surfaces", EGSR 2007), with exact Fresnel equations. Light scattered between
// facets leaves on both sides in lobes after Kulla and Conty (SIGGRAPH course, 2017), so that no light is
// lost at any roughness. With alpha 0 the surface is smooth.
//
// Radiance is stored divided by the squared index of refraction, as in Refractive. Refraction does not change
// this quotient. Therefore f(in, out) / n_in^2 = f(out, in) / n_out^2, and glass in uniform light is
// invisible.
template <class N>
struct Glass {
  Refractive<N> body;  // uses exact Fresnel equations
  N alpha;             // GGX parameter; 0: smooth
  // Single-scattering albedos of the facets, seen from outside and from inside.
  FacetAlbedo<N> outside, inside;
  // Transmitted fractions of multiply scattered light that arrives from outside and from inside.
  N through_outside, through_inside;

  template <class M>
  using Inputs = GlassInputs<M>;
  MaterialTraits traits() const {
    const bool filters = body.log2_filter != Vec3<N>(N(0)), is_rough = alpha > 0;
    return {.lit = is_rough,
            .mirrors = !is_rough,
            .transmits = true,
            .filters = filters,
            .glossy = is_rough,
            .non_diffuse = true,
            .fields = {.travelled = is_rough && filters}};
  }
  double mirrored_share() const { return alpha > 0 ? 0 : body.f0; }
  ReflectionLimits limits() const {
    return alpha > 0 ? ReflectionLimits{} : ReflectionLimits{Vec3d(0), Vec3d(0), Vec3d(1), true};
  }

  Medium medium() const { return body.medium(); }
  // As Refractive::between_media(). The albedos of rough facets stay those of facets in air.
  template <class T>
  Glass between_media(const SurfaceBatch<T>& surface, int i) const {
    Glass between = *this;
    between.body = body.between_media(surface, i);
    return between;
  }

  N rough() const { return alpha; }
  Vec3<N> ambient_reflectance(const N&, Lobes) const {
    const N one(ScalarOf<N>(1)), zero(ScalarOf<N>(0));
    return Vec3<N>(select(alpha > zero, one, zero));
  }

  Vec3<N> body_transmittance(const MaskOf<N>& is_inside, const N& travelled) const {
    return body.body_transmittance(is_inside, travelled);
  }

  // Evaluates the lobes with the generalised half vector V + eta L. eta is the index of refraction on the
  // light's side divided by the index on the viewer's side.
  [[gnu::always_inline]] Scattered<N> scattered(const Vec3<N>& viewer, const Vec3<N>& light,
                                                const MaskOf<N>& is_inside, Lobes) const {
    using T = ScalarOf<N>;
    using std::abs;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N zero(T(0)), one(T(1)), cosine = abs(light.z);
    const auto through = light.z < zero;
    const N far_index = select(is_inside, N(one / body.ior), body.ior);
    const N eta = select(through, far_index, one);
    const Vec3<N> h = viewer + light * eta;
    const Ggx<N> facets{alpha};
    const auto half = facets.along(h);
    const N along = select(h.z < zero, N(T(-1)), one) / half.length;
    const N to_viewer = dot(viewer, h) * along, to_light = dot(light, h) * along;
    const N seen = min_first(one, max_first(zero, to_viewer)), beyond = max_first(zero, -to_light);
    const N into = one / far_index;
    // Transmission uses both cosines, because near the critical angle one cosine barely determines the other.
    const N mirrored =
        select(through, fresnel_dielectric(into, seen, beyond), split_dielectric(into, seen).reflectance);
    // Jacobian d(half) / d(light), relative to the Jacobian of a mirror reflection.
    const N change = T(-4) * to_viewer * to_light * eta * eta / (half.length * half.length);
    const auto possible = half.length > zero && to_viewer > zero && (!through || to_light < zero);
    const N share = select(possible, select(through, N((one - mirrored) * change), mirrored), zero);

    const auto [passed_viewer, passed_light, spread] =
        multiple_scattering(viewer.z, cosine, is_inside, through);
    const Vec3<N> above(light.x, light.y, cosine);
    const N single = share * facets.brdf(viewer, above, half.density) * kPi;
    const N pdf = (one - passed_viewer) * share * facets.pdf(viewer, half.density) +
                  passed_viewer * spread.chance * cosine * (one / kPi);
    return {Vec3<N>((single + passed_viewer * passed_light * spread.chance * spread.scale) * cosine), pdf};
  }

  // Samples either a visible facet, which mirrors or refracts, or a cosine-weighted direction on either side
  // of the surface.
  DrawnDirection<N> drawn(const Vec3<N>& viewer, const MaskOf<N>& is_inside, Lobes,
                          const LobeDraw<N>& draw) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const N passed_viewer = one - choose(is_inside, inside, outside).at(min_first(one, viewer.z));
    const auto [evenly, u] = draw.choose(passed_viewer);
    const Vec3<N> facet = Ggx<N>{alpha}.visible_normal(viewer, u, draw.v);
    const N eta = select(is_inside, body.ior, N(one / body.ior));
    const N to_viewer = min_first(one, max_first(zero, dot(viewer, facet)));
    const auto split = split_dielectric(eta, to_viewer);
    const Vec3<N> refracted = facet * (eta * to_viewer - split.cos_transmitted) - viewer * eta;
    const auto refracts = draw.side >= split.reflectance;
    const Vec3<N> even = cosine_direction(Vec3<N>(zero, zero, one), u, draw.v);
    const auto even_through = draw.side < select(is_inside, through_inside, through_outside);
    const Vec3<N> across(even.x, even.y, select(even_through, N(-even.z), even.z));
    return {select(evenly, across, select(refracts, refracted, mirrored_about(viewer, facet))),
            (evenly && even_through) || (!evenly && refracts)};
  }

 private:
  // Lobe of multiple scattering on the light's side.
  struct MultipleLobe {
    N chance;  // probability of sampling the light's side
    N scale;   // 1 / (1 - mean albedo of the light's side); 0 if that albedo is 1
  };
  struct MultipleScattering {
    N viewer, light;  // fractions that are scattered between facets at the cosines of viewer and light
    MultipleLobe spread;
  };
  [[gnu::always_inline]] MultipleScattering multiple_scattering(const N& viewer, const N& light,
                                                                const MaskOf<N>& is_inside,
                                                                const MaskOf<N>& through) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const FacetAlbedo<N> near = choose(is_inside, inside, outside);
    const auto light_inside = is_inside != through;
    const FacetAlbedo<N> there = choose(light_inside, inside, outside);
    const N chance = select(is_inside, through_inside, through_outside);
    const N missing = one - there.mean;
    return {one - near.at(min_first(one, viewer)),
            one - there.at(min_first(one, light)),
            {select(through, chance, N(one - chance)),
             select(missing > zero, N(one / select(missing > zero, missing, one)), zero)}};
  }
  [[gnu::always_inline]] static FacetAlbedo<N> choose(const MaskOf<N>& mask, const FacetAlbedo<N>& yes,
                                                      const FacetAlbedo<N>& no) {
    if constexpr (!std::is_arithmetic_v<N>) {
      if (all(mask)) return yes;
      if (!any(mask)) return no;
    }
    FacetAlbedo<N> chosen;
    for (std::size_t k = 0; k < chosen.coefficients.size(); ++k)
      chosen.coefficients[k] = select(mask, yes.coefficients[k], no.coefficients[k]);
    chosen.scale = select(mask, yes.scale, no.scale);
    chosen.mean = select(mask, yes.mean, no.mean);
    return chosen;
  }
};

// Parameters of a Glass material, and the albedos of its facets.
template <class N>
struct GlassInputs {
  Vec3<N> filter;
  N ior, priority, roughness;
  N alpha;
  FacetAlbedo<N> outside, inside;
  N through_outside, through_inside;

  void read(MaterialParams& p);
  void read_boundary(MaterialParams& p);  // reads ior, roughness and priority
  void tabulate(double roughness);
  Glass<N> record() const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    return {{ior, normal_reflectance(ior, zero), one, log2_filter_of(filter), priority},
            alpha,
            outside,
            inside,
            through_outside,
            through_inside};
  }
};

}  // namespace orrery
