#pragma once

#include "core/materials/albedo_series.h"

namespace orrery {

// Single-scattering albedo E(mu) of GGX microfacets that mirror all light: the fraction of the light arriving
// at cosine mu that leaves without hitting a second facet. The scale of the series is alpha. The error is
// below 1e-3 for mu > 0.01.
template <class N>
using GgxAlbedo = AlbedoSeries<N, 14>;

// Returns the albedo for `alpha`, interpolated from a table. The first call computes the table by quadrature.
// Thread-safe. REQUIRES: 0 < alpha <= 1.
GgxAlbedo<double> ggx_albedo(double alpha);

}  // namespace orrery
