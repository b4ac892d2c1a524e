#pragma once

#include <numbers>

#include "core/materials/albedo_series.h"
#include "core/math/vec3.h"

namespace orrery {

// Albedo of Sheen as a series in the cosine to the normal. The error is below 2e-3 for mu > 0.01.
template <class N>
using SheenAlbedo = AlbedoSeries<N, 20>;

// Smallest alpha of Sheen: of a roughness of 0.07. Smaller ones have a narrow rim that no pixel resolves.
inline constexpr double kMinSheenAlpha = 0.0049;

// Fibres that stand on a surface, with normals around the horizon (Estevez, Kulla, "Production Friendly
// Microfacet Sheen BRDF", SIGGRAPH 2017): the density of the normals is (2 + 1/alpha) sin^(1/alpha) / (2 pi).
// Masking and shadowing use their fit of Smith's function without the softened terminator, and the
// visibility is at most 1, as in KHR_materials_sheen (Khronos). Directions are unit vectors in a frame whose
// third axis is the normal.
//
// Below a roughness of about 0.2, the fit reflects more light near the horizon than arrives. `scale` divides
// the BRDF by its largest albedo there.
template <class N>
struct Sheen {
  N alpha;  // from kMinSheenAlpha to 1
  N scale;  // at most 1

  // Returns the BRDF of white fibres. REQUIRES: both cosines are positive.
  [[gnu::always_inline]] N brdf(const Vec3<N>& viewer, const Vec3<N>& light) const {
    return density(viewer + light) * visible(viewer.z, light.z);
  }
  // Returns an upper bound on pi times brdf() times the cosine of the light.
  N most() const { return (ScalarOf<N>(1) + ScalarOf<N>(0.5) / alpha) * scale; }

  // Returns the density of normals along an unnormalised half vector.
  [[gnu::always_inline]] N density(const Vec3<N>& h) const {
    using T = ScalarOf<N>;
    const N one(T(1)), power = one / alpha, smallest(std::numeric_limits<T>::min());
    const N across = h.x * h.x + h.y * h.y;
    const N sine2 = min_first(one, N(across / max_first(smallest, N(across + h.z * h.z))));
    return (power + T(2)) * pow_unit(sine2, N(power * T(0.5))) * (T(0.5) / std::numbers::pi_v<T>);
  }
  // Returns brdf() divided by density().
  [[gnu::always_inline]] N visible(const N& viewer, const N& light) const {
    using T = ScalarOf<N>;
    const N one(T(1)), masked = one + lambda(viewer) + lambda(light);
    return scale * min_first(one, N(one / max_first(N(std::numeric_limits<T>::min()),
                                                    N(masked * viewer * light * T(4)))));
  }

 private:
  // Returns Smith's function for a direction at this cosine: e^f(x) below 1/2 and e^(2 f(1/2) - f(1 - x))
  // above, with f(x) = a / (1 + b x^c) + d x + e. The coefficients are those of alpha 0 and 1, interpolated
  // by (1 - alpha)^2.
  [[gnu::always_inline]] N lambda(const N& cosine) const {
    using T = ScalarOf<N>;
    const N one(T(1)), half(T(0.5)), share = (one - alpha) * (one - alpha);
    const auto between = [&](double rough, double smooth) {
      return N(T(rough) + (T(smooth) - T(rough)) * share);
    };
    const N a = between(21.5473, 25.3245), b = between(3.82987, 3.32435), c = between(0.19823, 0.16801),
            d = between(-1.97760, -1.27393), e = between(-4.32054, -4.85967);
    const auto exponent = [&](const N& x) { return N(a / (one + b * pow_unit(x, c)) + d * x + e); };
    const auto low = cosine < half;
    const N x = min_first(half, max_first(N(T(0)), select(low, cosine, N(one - cosine))));
    const N at_x = exponent(x);
    return exp2_flushed(N(select(low, at_x, N(T(2) * exponent(half) - at_x)) * std::numbers::log2e_v<T>));
  }
};

// White fibres, and the fraction of light that they reflect.
template <class N>
struct SheenLayer {
  Sheen<N> fibres;
  SheenAlbedo<N> albedo;
};
// Computes a layer by quadrature. Throws Cancelled. REQUIRES: kMinSheenAlpha <= alpha <= 1.
SheenLayer<double> make_sheen_layer(double alpha);

}  // namespace orrery
