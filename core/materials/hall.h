#pragma once

#include "core/materials/fresnel.h"
#include "core/materials/lobes.h"
#include "core/materials/refractive.h"

namespace orrery {

// Illumination model of Hall and Greenberg ("A Testbed for Realistic Image Synthesis", IEEE Computer Graphics
// and Applications 3(8), 1983): reflected and refracted rays, and the direct light of sources on both sides
// of the surface. Direct light is reflected and transmitted in a diffuse and a specular lobe. Specular terms
// are coloured by the Fresnel reflectance, and light is filtered per metre inside. A source and its image in
// a mirrored ray both count, so the model may create energy.
template <class N>
struct Hall {
  Vec3<N> ambient, diffuse;            // reflected ambient light, and direct light from the viewer's side
  Vec3<N> diffuse_transmission;        // direct light from the other side
  Vec3<N> specular, transmission;      // factors of specular reflection and transmission
  Vec3<N> tint;                        // colour of reflection along the normal
  N shininess, transmitted_shininess;  // exponents of N.H and N.H'
  Refractive<N> body;                  // index, filter and priority; uses exact Fresnel equations

  static Hall<double> read(Params& p);
  MaterialTraits traits() const {
    const Vec3<N> none(N(0));
    const bool mirrors = specular != none || transmission != none, filters = body.log2_filter != none;
    return {.lit = true,
            .mirrors = mirrors,
            .transmits = transmission != none || diffuse_transmission != none,
            .filters = filters,
            .glossy = mirrors || diffuse_transmission != none,
            .diffuse = diffuse != none || ambient != none,
            .non_diffuse = mirrors || diffuse_transmission != none,
            .fields = {.travelled = filters}};
  }
  RoundingLimit rounding() const;
  std::optional<Medium> medium() const {
    if (transmission == Vec3<N>(N(0))) return std::nullopt;
    Medium inside = body.medium();
    inside.refracts_only = false;
    return inside;
  }
  double max_albedo() const { return max_component(limits().albedo); }
  ReflectionLimits limits() const;
  // As Refractive::between_media().
  template <class T>
  Hall between_media(const SurfaceBatch<T>& surface, int i) const {
    Hall between = *this;
    between.body = body.between_media(surface, i);
    return between;
  }

  N rough() const { return N(ScalarOf<N>(1)); }
  Vec3<N> ambient_reflectance(const N&, Lobes lobes) const {
    return with_diffuse(lobes) ? ambient : Vec3<N>(N(ScalarOf<N>(0)));
  }
  Vec3<N> body_transmittance(const MaskOf<N>& is_inside, const N& travelled) const {
    return body.body_transmittance(is_inside, travelled);
  }

  // Returns the reflectance per channel if Fresnel's equations give `fresnel`: the tinted reflectance along
  // the normal, interpolated to 1 at total reflection (Cook, Torrance, "A Reflectance Model for Computer
  // Graphics", ACM Transactions on Graphics 1(1), 1982).
  [[gnu::always_inline]] Vec3<N> reflectance(const N& fresnel) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const N share = (fresnel - body.f0) / (one - body.f0);
    const auto channel = [&](const N& color) {
      const N along_normal = color * body.f0;
      return min_first(one, max_first(zero, N(along_normal + (one - along_normal) * share)));
    };
    return {channel(tint.x), channel(tint.y), channel(tint.z)};
  }
  // Index on the light's side divided by the index on the viewer's side, for light from the other side.
  [[gnu::always_inline]] N far_index(const MaskOf<N>& is_inside) const {
    return select(is_inside, N(N(ScalarOf<N>(1)) / body.ior), body.ior);
  }
  [[gnu::always_inline]] Vec3<N> reflectance_at(const N& cosine, const MaskOf<N>& is_inside) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    return reflectance(
        split_dielectric(N(one / far_index(is_inside)), min_first(one, max_first(zero, cosine))).reflectance);
  }

  // Returns the highlight of a source on the viewer's side: ks R(V.H) (N.H)^n, with H = (V + L) / |V + L|.
  [[gnu::always_inline]] Vec3<N> reflected_highlight(const Vec3<N>& viewer, const Vec3<N>& light,
                                                     const MaskOf<N>& is_inside) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const Vec3<N> sum = viewer + light;
    const N size = length(sum);
    const auto usable = size > zero;
    const Vec3<N> half = sum * (one / select(usable, size, one));
    const N base = min_first(one, max_first(zero, half.z));
    return specular * reflectance_at(dot(viewer, half), is_inside) *
           select(usable, pow_unit(base, shininess), zero);
  }
  // Returns the highlight of a source on the other side: kt (1 - R(V.H')) (N.H')^n'. H' is the normal of a
  // facet that refracts light from L toward V: V + m L divided by 1 - m and normalized, where m is
  // far_index(). No facet turns light if m is 1, and the term is then 0.
  [[gnu::always_inline]] Vec3<N> transmitted_highlight(const Vec3<N>& viewer, const Vec3<N>& light,
                                                       const MaskOf<N>& is_inside) const {
    using std::abs;
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1)), m = far_index(is_inside);
    const Vec3<N> sum = viewer + light * m;
    const N size = length(sum);
    const auto usable = size > zero && m != one;
    const N scale = select(m > one, N(-one), one) / select(usable, size, one);
    const N base = min_first(one, max_first(zero, N(sum.z * scale)));
    const Vec3<N> passed = Vec3<N>(one) - reflectance_at(abs(dot(viewer, sum) * scale), is_inside);
    return transmission * passed * select(usable, pow_unit(base, transmitted_shininess), zero);
  }

  // Probabilities of sampling a perfectly specular ray, of mirroring it, and of sampling the far side
  // otherwise.
  struct Chances {
    N specular, mirror, far;
  };
  [[gnu::always_inline]] Chances chances(const N& cosine, const MaskOf<N>& is_inside, Lobes lobes) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    if (!with_non_diffuse(lobes)) return {zero, zero, zero};
    const Vec3<N> mirrored = reflectance_at(cosine, is_inside);
    const N back = max_component(specular * mirrored);
    const N on = max_component(transmission * (Vec3<N>(one) - mirrored));
    // Highlights may be seen where rays are not mirrored or refracted.
    const N near =
        (with_diffuse(lobes) ? max_component(diffuse) : zero) + max_component(specular) / (shininess + one);
    const N far =
        max_component(diffuse_transmission) + max_component(transmission) / (transmitted_shininess + one);
    return {lobe_chance(N(back + on), N(near + far)), lobe_chance(back, on), lobe_chance(far, near)};
  }

  // Evaluates the lobes of direct light.
  [[gnu::always_inline]] Scattered<N> scattered(const Vec3<N>& viewer, const Vec3<N>& light,
                                                const MaskOf<N>& is_inside, Lobes lobes) const {
    using std::abs;
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1)), cosine = abs(light.z);
    const auto through = light.z < zero;
    const Chances chance = chances(viewer.z, is_inside, lobes);
    const N pdf =
        (one - chance.specular) * select(through, chance.far, N(one - chance.far)) * cosine_pdf(cosine);
    Vec3<N> found = with_diffuse(lobes) ? select(through, Vec3<N>(zero), diffuse * cosine) : Vec3<N>(zero);
    if (!with_non_diffuse(lobes)) return {found, pdf};
    if (!all(through))
      found = found + select(through, Vec3<N>(zero), reflected_highlight(viewer, light, is_inside));
    if (any(through))
      found = found + select(through,
                             diffuse_transmission * cosine + transmitted_highlight(viewer, light, is_inside),
                             Vec3<N>(zero));
    return {found, pdf};
  }
  // Samples a cosine-weighted direction on either side.
  DrawnDirection<N> drawn(const Vec3<N>& viewer, const MaskOf<N>& is_inside, Lobes lobes,
                          const LobeDraw<N>& draw) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const auto through = draw.side < chances(viewer.z, is_inside, lobes).far;
    const Vec3<N> even = cosine_direction(Vec3<N>(zero, zero, one), draw.u, draw.v);
    return {Vec3<N>(even.x, even.y, select(through, N(-even.z), even.z)), through};
  }
};

}  // namespace orrery
