#pragma once

#include "core/materials/fresnel.h"
#include "core/materials/lobes.h"
#include "core/materials/microfacet.h"
#include "core/math/elementary.h"

namespace orrery {

class MaterialParams;
template <class N>
struct CookTorranceInputs;

// Cook-Torrance model ("A Reflectance Model for Computer Graphics", TOG 1982): a diffuse lobe plus facets in
// V-shaped grooves with Beckmann-distributed slopes. Light reflected between facets is lost, as in the paper.
//
// The facet reflection is F D G / (4 N.L N.V), with a density D of normals whose projection on the surface
// integrates to 1. Microfacet theory gives this factor (Walter et al., "Microfacet Models for Refraction
// through Rough Surfaces", EGSR 2007, equation 20). The paper has F D G / (pi N.L N.V) with pi times this
// density, which is 4 times as much: rough metals would reflect more light than they receive.
template <class N>
struct CookTorrance {
  Vec3<N> n, k;      // index of refraction and extinction of the facets
  Vec3<N> diffuse;   // diffuse albedo
  Vec3<N> specular;  // weight of the facet reflection
  N slope;           // root mean square slope of the facets
  N chance;          // probability of sampling a facet, with Lobes::all

  template <class M>
  using Inputs = CookTorranceInputs<M>;
  MaterialTraits traits() const {
    return {.lit = true, .glossy = true, .diffuse = true, .non_diffuse = true};
  }

  N rough() const { return N(ScalarOf<N>(1)); }
  Vec3<N> ambient_reflectance(const N&, Lobes lobes) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    return diffuse * (with_diffuse(lobes) ? one : zero) +
           specular * reflectance(one) * (with_non_diffuse(lobes) ? one : zero);
  }
  // Returns the probability of sampling a facet. Otherwise, drawn() samples a cosine-weighted direction.
  N facet_chance(Lobes lobes) const {
    return lobes == Lobes::all ? chance : N(ScalarOf<N>(with_non_diffuse(lobes) ? 1 : 0));
  }
  Vec3<N> body_transmittance(const MaskOf<N>&, const N&) const { return Vec3<N>(N(ScalarOf<N>(1))); }

  [[gnu::always_inline]] Vec3<N> reflectance(const N& cosine) const {
    return {fresnel_conductor(n.x, k.x, cosine), fresnel_conductor(n.y, k.y, cosine),
            fresnel_conductor(n.z, k.z, cosine)};
  }

  // Evaluates the model: Beckmann's normal density exp(-tan^2 / m^2) / (pi m^2 cos^4), and the masking term
  // of V-shaped grooves, min(1, 2 H.N V.N / V.H, 2 H.N L.N / V.H).
  [[gnu::always_inline]] Scattered<N> scattered(const Vec3<N>& viewer, const Vec3<N>& light, const MaskOf<N>&,
                                                Lobes lobes) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    constexpr T kPi = std::numbers::pi_v<T>, kLog2E = std::numbers::log2e_v<T>;
    constexpr T kMinExponent = -60;  // exponent of 2 below which the density is 0
    const N zero(T(0)), one(T(1));
    const auto lit = light.z > zero;
    const N cosine = select(lit, light.z, one);
    const N even = cosine * (one / kPi);
    const Vec3<N> matt = with_diffuse(lobes) ? diffuse * cosine : Vec3<N>(zero);
    if (!with_non_diffuse(lobes)) return {matt, select(lit, even, zero)};
    const Vec3<N> h(viewer.x + light.x, viewer.y + light.y, viewer.z + cosine);
    const N across = h.x * h.x + h.y * h.y, up2 = h.z * h.z, length2 = across + up2;
    const N exponent = across / (up2 * slope * slope) * (-kLog2E);
    const auto stands = exponent > N(kMinExponent);
    const N ratio = select(stands, N(length2 / up2), one);
    const N density = select(stands, N(exp2_flushed(select(stands, exponent, zero)) * ratio * ratio), zero) *
                      (one / (kPi * slope * slope));
    const N half = sqrt(length2), to_viewer = half * T(0.5), up = h.z / half;
    const N groove = T(2) * up * min_first(viewer.z, cosine) / to_viewer;
    const N single = density * min_first(one, groove) * (kPi / T(4)) / viewer.z;
    const N drawn = density * up / (T(4) * to_viewer);
    const N share = facet_chance(lobes);
    return {matt + specular * reflectance(min_first(one, to_viewer)) * single,
            select(lit, N(share * drawn + (one - share) * cosine * (one / kPi)), zero)};
  }

  DrawnDirection<N> drawn(const Vec3<N>& viewer, const MaskOf<N>&, Lobes lobes,
                          const LobeDraw<N>& draw) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    constexpr T kLn2 = std::numbers::ln2_v<T>;
    const N zero(T(0)), one(T(1));
    const auto [mirrors, u] = draw.choose(facet_chance(lobes));
    const N tangent2 = max_first(zero, N(log2_normal(one - u) * (-kLn2) * slope * slope));
    const N up = one / sqrt(one + tangent2), across = sqrt(tangent2) * up;
    const auto [sine, cosine] = sine_cosine_turns(draw.v);
    const Vec3<N> facet(across * cosine, across * sine, up);
    return {
        select(mirrors, mirrored_about(viewer, facet), cosine_direction(Vec3<N>(zero, zero, one), u, draw.v)),
        MaskOf<N>(false)};
  }
};

// Parameters of a CookTorrance material.
template <class N>
struct CookTorranceInputs {
  Vec3<N> n, k, diffuse, specular;
  N slope;

  void read(MaterialParams& p);
  CookTorrance<N> record() const {
    using T = ScalarOf<N>;
    CookTorrance<N> found{n, k, diffuse, specular, slope, N(T(0))};
    found.chance =
        lobe_chance(N(max_component(specular * found.reflectance(N(T(0.7))))), N(max_component(diffuse)));
    return found;
  }
};

}  // namespace orrery
