#pragma once

#include <numbers>

#include "core/math/elementary.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

class MaterialParams;
template <class N>
struct OrenNayarInputs;

// Rough diffuse surface of facets, such as clay or plaster: the Oren-Nayar model ("Generalization of
// Lambert's reflectance model", SIGGRAPH 1994) as improved by Fujii. A lobe for multiple scattering between
// facets keeps the albedo of a white surface at 1 (Portsmouth, Kutz, Hill, "EON: a practical
// energy-preserving rough diffuse BRDF", 2024). Roughness 0 is Lambertian.
template <class N>
struct OrenNayar {
  Vec3<N> reflectance;
  N roughness;
  N single_scale;          // A of Fujii's model
  Vec3<N> multiple_scale;  // factor of grazing_loss(N.L) * grazing_loss(N.V)

  template <class M>
  using Inputs = OrenNayarInputs<M>;
  MaterialTraits traits() const { return {.lit = true, .glossy = true, .diffuse = true}; }
  // Uses N.L s / t <= 1 and grazing_loss() <= kFujii: see pi_brdf().
  ReflectionLimits limits() const {
    return {reflectance, reflectance * (single_scale * (1 + roughness)) + multiple_scale * (kFujii * kFujii)};
  }

  // Returns reflectance * A (1 + roughness s / t) plus multiple scattering. s is L.V - N.L N.V, and t is
  // max(N.L, N.V) if s > 0, else 1. N.V is clamped to [0, 1], because an interpolated normal may face away
  // from the viewer.
  [[gnu::always_inline]] Vec3<N> pi_brdf(const N& light, const N& viewer, const N& between) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    const N v = min_first(one, max_first(zero, viewer)), l = min_first(one, light);
    const N s = between - l * v;
    const N t = select(s > zero, max_first(l, v), one);
    return reflectance * (single_scale * (one + roughness * s / t)) +
           multiple_scale * (grazing_loss(l) * grazing_loss(v));
  }

  // kFujii is 1/2 - 2 / (3 pi), used in A. kMeanG is 2/3 - 28 / (15 pi), the cosine-weighted mean of G / pi
  // over the hemisphere.
  static constexpr double kFujii = 0.5 - 2 / (3 * std::numbers::pi);
  static constexpr double kMeanG = 2.0 / 3 - 28 / (15 * std::numbers::pi);

  // Returns the fraction of light that facets of a white surface do not reflect in one bounce, divided by A
  // and the roughness: kFujii - G / pi. G is S (acos mu - S mu) + 2/3 ((S / mu) (1 - S^3) - S), where S =
  // sqrt(1 - mu^2). Written with 1 - S = mu^2 / (1 + S), G needs no division by mu.
  [[gnu::always_inline]] static N grazing_loss(const N& mu) {
    using T = ScalarOf<N>;
    using std::sqrt;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N zero(T(0)), one(T(1));
    const N sine = sqrt(max_first(zero, N(one - mu * mu)));
    const N angle = direction_turns(mu, sine) * (2 * kPi);
    const N steep = sine * (mu * (one + sine + sine * sine) / (one + sine)) - sine;
    const N g = sine * (angle - sine * mu) + steep * T(2.0 / 3);
    return max_first(zero, N(T(kFujii) - g * (1 / kPi)));
  }
};

// Parameters of an OrenNayar material. Multiple scattering reflects the fraction rho^2 E / (1 - rho (1 - E)),
// the sum over all bounces between facets. rho is the reflectance of a facet. E is the mean albedo of white
// facets.
template <class N>
struct OrenNayarInputs {
  Vec3<N> reflectance;
  N roughness;

  void read(MaterialParams& p);
  OrenNayar<N> record() const {
    using T = ScalarOf<N>;
    constexpr T kFujii = T(OrenNayar<N>::kFujii), kMeanG = T(OrenNayar<N>::kMeanG);
    const N one(T(1)), a = one / (one + kFujii * roughness), mean = a * (one + kMeanG * roughness);
    const auto multiple = [&](const N& rho) {
      return rho * rho * mean / (one - rho * (one - mean)) * (a * roughness / (kFujii - kMeanG));
    };
    return {reflectance, roughness, a,
            Vec3<N>(multiple(reflectance.x), multiple(reflectance.y), multiple(reflectance.z))};
  }
};

}  // namespace orrery
