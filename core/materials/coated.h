#pragma once

#include "core/materials/metallic_roughness.h"
#include "core/materials/sheen.h"

namespace orrery {

template <class N>
struct CoatedInputs;

// MetallicRoughness under fibres (KHR_materials_sheen) under a clear coat of index 1.5 (Khronos,
// KHR_materials_clearcoat), which covers the fraction `coat` of the surface. The light that a layer does not
// reflect reaches the layers below: the smaller one of its fractions for the viewer's and the light's
// direction, so that the layers together never reflect more light than arrives. Light that the coat reflects
// back to the base is absorbed.
template <class N>
struct Coated {
  MetallicRoughness<N> base;
  Vec3<N> sheen_color;
  SheenLayer<N> sheen;
  N coat;
  N coat_alpha;                // GGX parameter
  FacetAlbedo<N> coat_albedo;  // albedo of a coat that covers the whole surface

  template <class M>
  using Inputs = CoatedInputs<M>;
  MaterialTraits traits() const { return base.traits(); }
  ReflectionLimits limits() const {
    ReflectionLimits most = base.limits();
    most.light =
        most.light + sheen_color * sheen.fibres.most() + Vec3d(coat * Ggx<double>{coat_alpha}.most());
    return most;
  }

  N rough() const { return N(ScalarOf<N>(1)); }
  Vec3<N> body_transmittance(const MaskOf<N>&, const N&) const { return Vec3<N>(N(ScalarOf<N>(1))); }
  // Passes uniform light to diffuse lobes with the smaller one of the viewer's and the mean fraction.
  Vec3<N> ambient_reflectance(const N& cosine, Lobes lobes) const {
    const N one(ScalarOf<N>(1)), zero(ScalarOf<N>(0));
    const Layers seen = layers(cosine);
    const N even = min_first(seen.past_coat, N(one - coat * coat_albedo.mean));
    const N even_base =
        even * min_first(seen.past_sheen, N(one - max_component(sheen_color) * sheen.albedo.mean));
    Vec3<N> sum(zero);
    if (with_non_diffuse(lobes))
      sum = Vec3<N>(seen.coat) +
            base.ambient_reflectance(cosine, Lobes::non_diffuse) * (seen.past_coat * seen.past_sheen);
    if (with_diffuse(lobes))
      sum = sum + sheen_color * (seen.sheen * even) +
            base.ambient_reflectance(cosine, Lobes::diffuse) * even_base;
    return sum;
  }

  [[gnu::always_inline]] Scattered<N> scattered(const Vec3<N>& viewer, const Vec3<N>& light,
                                                const MaskOf<N>& inside, Lobes lobes) const {
    using T = ScalarOf<N>;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N zero(T(0)), one(T(1));
    const auto lit = light.z > zero;
    const N cosine = select(lit, light.z, one);
    const Vec3<N> toward(light.x, light.y, cosine);
    const Layers seen = layers(viewer.z), given = layers(cosine);
    const Chances chances = chances_of(seen, viewer.z, lobes);
    const N past_coat = min_first(seen.past_coat, given.past_coat);
    const N past_sheen = past_coat * min_first(seen.past_sheen, given.past_sheen);
    const Scattered<N> below = base.scattered(viewer, light, inside, lobes);
    Scattered<N> found{below.pi_bsdf_cos * past_sheen,
                       chances.sheen * cosine * (one / kPi) + chances.base * below.pdf};
    if (with_diffuse(lobes))
      found.pi_bsdf_cos =
          found.pi_bsdf_cos + sheen_color * (past_coat * sheen.fibres.brdf(viewer, toward) * cosine * kPi);
    if (with_non_diffuse(lobes)) {
      const Ggx<N> facets{coat_alpha};
      const auto half = facets.half(viewer, light);
      const N fresnel = fresnel_schlick(N(T(kCoatReflectance)), min_first(one, N(half.length * T(0.5))));
      found.pi_bsdf_cos = found.pi_bsdf_cos +
                          Vec3<N>(coat * fresnel * facets.brdf(viewer, toward, half.density) * cosine * kPi);
      found.pdf = found.pdf + chances.coat * facets.pdf(viewer, half.density);
    }
    found.pdf = select(lit, found.pdf, zero);
    return found;
  }

  DrawnDirection<N> drawn(const Vec3<N>& viewer, const MaskOf<N>& inside, Lobes lobes,
                          const LobeDraw<N>& draw) const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const Chances chances = chances_of(layers(viewer.z), viewer.z, lobes);
    const auto [is_coat, u] = draw.choose(chances.coat);
    const N rest = chances.sheen + chances.base;
    const auto [is_sheen, w] =
        LobeDraw<N>{u, draw.v, draw.side}.choose(N(chances.sheen / select(rest > zero, rest, one)));
    const DrawnDirection<N> below = base.drawn(viewer, inside, lobes, {w, draw.v, draw.side});
    const Vec3<N> facet = Ggx<N>{coat_alpha}.visible_normal(viewer, u, draw.v);
    const Vec3<N> around = cosine_direction(Vec3<N>(zero, zero, one), w, draw.v);
    return {select(is_coat, mirrored_about(viewer, facet), select(is_sheen, around, below.direction)),
            below.through};
  }

 private:
  friend struct CoatedInputs<N>;
  friend struct CoatedInputs<double>;
  static constexpr double kCoatReflectance = 0.04;  // along the normal, of an index of refraction of 1.5

  // Fractions of the light at one cosine: `coat` and `sheen` reflect theirs, sheen in white, and the rest
  // passes.
  struct Layers {
    N coat, past_coat, sheen, past_sheen;
  };
  [[gnu::always_inline]] Layers layers(const N& cosine) const {
    const N one(ScalarOf<N>(1)), mu = min_first(one, cosine);
    const N mirrored = coat * coat_albedo.at(mu), white = sheen.albedo.at(mu);
    return {mirrored, one - mirrored, white, one - white * max_component(sheen_color)};
  }

  // Probabilities of sampling each layer.
  struct Chances {
    N coat, sheen, base;
  };
  [[gnu::always_inline]] Chances chances_of(const Layers& seen, const N& cosine, Lobes lobes) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const N coat_share = with_non_diffuse(lobes) ? seen.coat : zero;
    const N sheen_share =
        with_diffuse(lobes) ? N(seen.past_coat * seen.sheen * max_component(sheen_color)) : zero;
    const N base_share =
        seen.past_coat * seen.past_sheen * max_component(base.ambient_reflectance(cosine, lobes));
    const N of_coat = with_non_diffuse(lobes) ? lobe_chance(coat_share, N(sheen_share + base_share)) : zero;
    const N of_sheen = with_diffuse(lobes) ? lobe_chance(sheen_share, base_share) : zero;
    return {of_coat, (one - of_coat) * of_sheen, (one - of_coat) * (one - of_sheen)};
  }
};

// Parameters of a Coated material, and the albedos of its layers.
template <class N>
struct CoatedInputs {
  Vec3<N> sheen_color;
  SheenLayer<N> sheen;
  N coat, coat_alpha;
  FacetAlbedo<N> coat_albedo;
  Vec3<N> base_color, normal_reflectance;
  N metallic, roughness;
  N alpha;
  GgxAlbedo<N> albedo;
  FacetAlbedo<N> grazing;

  void read(MaterialParams& p);
  void tabulate(double roughness);
  Coated<N> record() const {
    const N not_strict(ScalarOf<N>(0));
    const MetallicRoughnessInputs<N> base{
        base_color, normal_reflectance, metallic, not_strict, roughness, alpha, albedo, grazing};
    return {base.record(), sheen_color, sheen, coat, coat_alpha, coat_albedo};
  }
};

}  // namespace orrery
