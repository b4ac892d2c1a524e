#pragma once

#include <cmath>

#include "core/base/task_scope.h"
#include "core/materials/albedo_series.h"
#include "core/materials/microfacet.h"

// Albedos of GGX microfacets with Fresnel reflection, computed by quadrature when a material is read.
namespace orrery {

inline constexpr double kMinAlpha = 1e-3;  // smallest GGX alpha of a rough surface

template <class N>
using FacetAlbedo = AlbedoSeries<N, 20>;

// Returns the mean of share(viewer, normal, seen) over the normals visible from a viewer at cosine mu, as a
// series in mu with this `scale`. seen(c) is G2 / G1 for light at cosine c. Samples the normals on a
// Fibonacci lattice over half of the azimuths, because the other half is symmetric. The absolute error is up
// to 1e-3 if `share` has a step at the critical angle, and up to 2e-4 if `share` is smooth. Throws Cancelled.
template <class Share>
FacetAlbedo<double> facet_albedo(double alpha, double scale, const Share& share) {
  constexpr std::size_t kTerms = std::tuple_size_v<decltype(FacetAlbedo<double>::coefficients)>;
  constexpr int kPoints = 2048;
  constexpr double kGoldenRatio = 0.61803398874989485;
  const Ggx<double> facets{alpha};
  std::array<double, kTerms> values{};
  for (std::size_t k = 0; k < kTerms; ++k) {
    checkpoint();
    const double mu = series_node<kTerms>(scale, k);
    const Vec3d viewer(std::sqrt(1 - mu * mu), 0, mu);
    const auto seen = [&](double light) {
      return light * (mu + facets.stretched(mu)) /
             (light * facets.stretched(mu) + mu * facets.stretched(light));
    };
    for (int i = 0; i < kPoints; ++i) {
      const double turn = i * kGoldenRatio, around = (turn - std::floor(turn)) / 2;
      values[k] += share(viewer, facets.visible_normal(viewer, (i + 0.5) / kPoints, around), seen) / kPoints;
    }
  }
  return series_through(values, scale);
}

// Returns the albedo of facets that mirror the fraction fresnel(cosine to the facet normal). Throws
// Cancelled.
template <class Fresnel>
FacetAlbedo<double> mirrored_albedo(double alpha, const Fresnel& fresnel) {
  const auto share = [&](const Vec3d& viewer, const Vec3d& normal, const auto& seen) {
    const double light = mirrored_about(viewer, normal).z;
    return light > 0 ? fresnel(dot(viewer, normal)) * seen(light) : 0.0;
  };
  constexpr double kMinScale = 0.1;  // the width of Fresnel terms in mu does not depend on alpha
  return facet_albedo(alpha, std::max(alpha, kMinScale), share);
}

}  // namespace orrery
