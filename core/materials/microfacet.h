#pragma once

#include <numbers>

#include "core/math/elementary.h"
#include "core/math/vec3.h"

namespace orrery {

// Mirroring microfacets with GGX-distributed normals (Walter, Marschner, Li, Torrance, "Microfacet Models for
// Refraction through Rough Surfaces", EGSR 2007) and Smith's height-correlated masking and shadowing (Heitz,
// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 2014). Directions are unit
// vectors away from the surface, in a frame whose third axis is the normal.
template <class N>
struct Ggx {
  N alpha;  // in (0, 1]

  // Length of the half vector h = V + L, and the normal density D(h) = alpha^2 / (pi (sin^2 h + alpha^2 cos^2
  // h)^2). The length of h is twice the cosine between h and each direction. The sine is computed from the
  // tangential components, because 1 - cos^2 cancels in float.
  struct Half {
    N length, density;
  };
  [[gnu::always_inline]] Half half(const Vec3<N>& viewer, const Vec3<N>& light) const {
    return along(viewer + light);
  }
  // Returns the length of an unnormalised half vector, and the normal density in its direction.
  [[gnu::always_inline]] Half along(const Vec3<N>& h) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N alpha2 = alpha * alpha;
    const N across = h.x * h.x + h.y * h.y, length2 = across + h.z * h.z;
    const N ratio = min_first(N(T(1) / alpha2), N(length2 / (across + alpha2 * h.z * h.z)));
    return {sqrt(length2), alpha2 * ratio * ratio * (T(1) / std::numbers::pi_v<T>)};
  }

  // Returns cos (1 + 2 Lambda), where Lambda is Smith's auxiliary function for a direction at this cosine to
  // the normal.
  [[gnu::always_inline]] N stretched(const N& cosine) const {
    using std::sqrt;
    const N alpha2 = alpha * alpha;
    return sqrt(alpha2 + (ScalarOf<N>(1) - alpha2) * cosine * cosine);
  }

  // Returns D G2 / (4 N.V N.L), the BRDF of facets that mirror all light.
  [[gnu::always_inline]] N brdf(const Vec3<N>& viewer, const Vec3<N>& light, const N& density) const {
    return density * ScalarOf<N>(0.5) / (light.z * stretched(viewer.z) + viewer.z * stretched(light.z));
  }

  // Returns an upper bound on pi times brdf() times the cosine of the light: D is at most 1 / (pi alpha^2),
  // and stretched() is at least alpha.
  N most() const { return ScalarOf<N>(0.5) / (alpha * alpha * alpha); }

  // Returns the density per solid angle of a ray mirrored about visible_normal(): G1 D / (4 N.V).
  [[gnu::always_inline]] N pdf(const Vec3<N>& viewer, const N& density) const {
    return density * ScalarOf<N>(0.5) / (viewer.z + stretched(viewer.z));
  }

  // Samples a normal visible to the viewer, from u and v in [0, 1), as a point on a spherical cap (Dupuy,
  // Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023, after Heitz, JCGT 2018).
  [[gnu::always_inline]] Vec3<N> visible_normal(const Vec3<N>& viewer, const N& u, const N& v) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N zero(T(0)), one(T(1));
    const Vec3<N> hemisphere = normalize(Vec3<N>(alpha * viewer.x, alpha * viewer.y, viewer.z));
    const N depth = u * (one + hemisphere.z);  // depth of the sampled point below the pole
    const N radius = sqrt(max_first(zero, N(depth * (T(2) - depth))));
    const auto [sine, cosine] = sine_cosine_turns(v);
    return normalize(Vec3<N>(alpha * (radius * cosine + hemisphere.x), alpha * (radius * sine + hemisphere.y),
                             (one + hemisphere.z) * (one - u)));
  }
};

// Returns `viewer` mirrored about a microfacet's normal.
template <class N>
[[gnu::always_inline]] inline Vec3<N> mirrored_about(const Vec3<N>& viewer, const Vec3<N>& normal) {
  return normal * (ScalarOf<N>(2) * dot(viewer, normal)) - viewer;
}

}  // namespace orrery
