#pragma once

#include "core/math/elementary.h"
#include "core/math/vec3.h"
#include "core/model/material.h"

namespace orrery {

// Ambient, Lambert diffuse and a Phong or Blinn-Phong highlight.
template <class N>
struct Rough {
  Vec3<N> ambient, diffuse, specular;  // coefficient times colour
  N shininess;
  N phong;  // 1: the mirrored light direction decides the highlight, 0: the half vector

  static Rough<double> read(Params& p);
  MaterialTraits traits() const { return {.lit = true, .glossy = specular != Vec3<N>(N(0))}; }
  RoundingLimit rounding() const;
  double most_reflected() const { return max_component(limits().albedo); }
  ReflectionLimits limits() const;

  // Cosine that the highlight is a power of, 0 where there is none. Unit vectors: normal, toward the light,
  // toward the viewer, and half way between the two. The mirrored direction is R = 2 (N.L) N - L.
  [[gnu::always_inline]] N highlight(const Vec3<N>& normal, const Vec3<N>& light, const Vec3<N>& viewer,
                                     const Vec3<N>& half, const N& cosine) const {
    using T = ScalarOf<N>;
    const N mirrored = T(2) * cosine * dot(normal, viewer) - dot(light, viewer);
    const N c = select(phong > N(T(0)), mirrored, dot(normal, half));
    return min_first(N(T(1)), max_first(N(T(0)), c));
  }

  // Share of light from `light` that leaves toward `viewer`, cosine included. REQUIRES: cosine = N.L > 0.
  [[gnu::always_inline]] Vec3<N> reflected(const Vec3<N>& normal, const Vec3<N>& light, const Vec3<N>& viewer,
                                           const Vec3<N>& half, const N& cosine) const {
    const N zero(ScalarOf<N>(0));
    const N base = highlight(normal, light, viewer, half, cosine);
    const N lobe = select(dot(normal, viewer) > zero, pow_unit(base, shininess), zero);
    return diffuse * cosine + specular * lobe;
  }
};

// H = (L + V) / |L + V|; zero where the two are opposite.
template <class N>
[[gnu::always_inline]] inline Vec3<N> half_vector(const Vec3<N>& light, const Vec3<N>& viewer) {
  using T = ScalarOf<N>;
  using std::sqrt;
  const Vec3<N> sum = light + viewer;
  const N size2 = dot(sum, sum);
  return sum * select(size2 > N(T(0)), N(T(1) / sqrt(size2)), N(T(0)));
}

}  // namespace orrery
