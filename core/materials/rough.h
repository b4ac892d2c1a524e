#pragma once

#include <numbers>
#include <span>

#include "core/math/elementary.h"
#include "core/math/hemisphere.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

class MaterialParams;
template <class N>
struct RoughInputs;

// Ambient light, Lambertian reflection and a Phong or Blinn-Phong highlight.
template <class N>
struct Rough {
  Vec3<N> ambient, diffuse, specular;  // coefficient times colour
  N shininess;
  N phong;   // 1: Phong (mirrored light direction), 0: Blinn-Phong (half vector)
  N chance;  // probability of sampling the highlight, with Lobes::all: 0 or 1

  template <class M>
  using Inputs = RoughInputs<M>;
  MaterialTraits traits() const {
    const Vec3<N> none(N(0));
    return {.lit = true,
            .glossy = specular != none,
            .diffuse = diffuse != none || ambient != none,
            .non_diffuse = specular != none};
  }
  RoundingLimit rounding() const;
  double max_albedo() const { return max_component(limits().albedo); }
  ReflectionLimits limits() const;
  // Returns the albedo of a highlight with coefficient 1 for a view along the normal, where the horizon cuts
  // off the least.
  double highlight_albedo() const;

  // Returns the cosine that is raised to the power `shininess`: R.V for Phong, N.H for Blinn-Phong, clamped
  // to [0, 1]. R = 2 (N.L) N - L is the mirrored direction of the light, and `cosine` is N.L. All vectors are
  // unit.
  [[gnu::always_inline]] N highlight(const Vec3<N>& normal, const Vec3<N>& light, const Vec3<N>& viewer,
                                     const Vec3<N>& half, const N& cosine) const {
    using T = ScalarOf<N>;
    const N mirrored = T(2) * cosine * dot(normal, viewer) - dot(light, viewer);
    const N c = select(phong > N(T(0)), mirrored, dot(normal, half));
    return min_first(N(T(1)), max_first(N(T(0)), c));
  }

  // Minimum exponent for sampling the highlight. Cosine-weighted sampling is used for lower exponents.
  static constexpr double kMinShininess = 1;
  [[gnu::always_inline]] N highlight_chance(Lobes lobes) const {
    const N zero(ScalarOf<N>(0)), one(ScalarOf<N>(1));
    if (lobes == Lobes::all) return chance;
    return with_non_diffuse(lobes) ? select(shininess >= N(ScalarOf<N>(kMinShininess)), one, zero) : zero;
  }

  // Result of scattered(): pi_bsdf_cos for light from `light` toward `viewer`, and the sampling density.
  struct Scattered {
    Vec3<N> pi_bsdf_cos;
    N pdf;
  };
  // Evaluates the lobes. REQUIRES: cosine = N.L > 0. A Phong highlight is sampled in proportion to a power of
  // the cosine to the mirrored viewer. A Blinn-Phong highlight is sampled in proportion to a power of N.H.
  // The factor 1 / (4 V.H) converts that density to the solid angle of the light.
  [[gnu::always_inline]] Scattered scattered(const Vec3<N>& normal, const Vec3<N>& light,
                                             const Vec3<N>& viewer, const Vec3<N>& half, const N& cosine,
                                             Lobes lobes) const {
    using T = ScalarOf<N>;
    constexpr T kPi = std::numbers::pi_v<T>;
    const N zero(T(0)), one(T(1));
    const N base = highlight(normal, light, viewer, half, cosine);
    const N lobe = select(dot(normal, viewer) > zero, pow_unit(base, shininess), zero);
    const Vec3<N> matt = with_diffuse(lobes) ? diffuse * cosine : Vec3<N>(zero);
    Scattered found{with_non_diffuse(lobes) ? matt + specular * lobe : matt, cosine_pdf(cosine)};
    const auto drawn = highlight_chance(lobes) > zero;
    if (!any(drawn)) return found;
    const N spread = select(phong > zero, one, N(T(4) * dot(half, viewer)));
    const N density = lobe * (shininess + one) * (T(0.5) / kPi) / select(spread > zero, spread, one);
    found.pdf = select(drawn, density, found.pdf);
    return found;
  }

  // Samples the highlight with the density of scattered(), from u and v in [0, 1). Undefined in lanes with
  // N.V <= 0.
  [[gnu::always_inline]] Vec3<N> drawn_highlight(const Vec3<N>& normal, const Vec3<N>& viewer, const N& u,
                                                 const N& v) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N zero(T(0)), one(T(1));
    const N up = pow_unit(one - u, one / (shininess + one));
    const N across = sqrt(max_first(zero, N(one - up * up)));
    const auto [sine, cosine] = sine_cosine_turns(v);
    const auto mirrored_about = [&](const Vec3<N>& axis) {
      return axis * (T(2) * dot(axis, viewer)) - viewer;
    };
    const Vec3<N> axis = select(phong > zero, mirrored_about(normal), normal);
    const Tangents<N> basis = tangents_of(axis);
    const Vec3<N> direction = basis.first * (across * cosine) + basis.second * (across * sine) + axis * up;
    return normalize(select(phong > zero, direction, mirrored_about(direction)));
  }
};

// Returns a kernel of these materials, numbered from `first`, for materials that add other lobes.
MaterialKernelPtr<float> make_rough_kernel(float, std::span<const Rough<double>> records, int first);
MaterialKernelPtr<double> make_rough_kernel(double, std::span<const Rough<double>> records, int first);
// Reads a Rough material whose parameters are not textured.
Rough<double> read_rough(Params& p);

// Parameters of a Rough material.
template <class N>
struct RoughInputs {
  Vec3<N> kd, ka, ks, diffuse_color, specular_color;
  N shininess;
  N phong;

  void read(MaterialParams& p);
  Rough<N> record() const {
    using T = ScalarOf<N>;
    const N zero(T(0)), one(T(1));
    const Vec3<N> diffuse = kd * diffuse_color, specular = ks * specular_color;
    const auto alone = !(max_component(diffuse) > zero) && max_component(specular) > zero &&
                       shininess >= N(T(Rough<N>::kMinShininess));
    return {ka * diffuse_color, diffuse, specular, shininess, phong, select(alone, one, zero)};
  }
};

// Returns H = (L + V) / |L + V|, or the zero vector if L = -V.
template <class N>
[[gnu::always_inline]] inline Vec3<N> half_vector(const Vec3<N>& light, const Vec3<N>& viewer) {
  using T = ScalarOf<N>;
  using std::sqrt;
  const Vec3<N> sum = light + viewer;
  const N size2 = dot(sum, sum);
  return sum * select(size2 > N(T(0)), N(T(1) / sqrt(size2)), N(T(0)));
}

}  // namespace orrery
