#pragma once

#include "core/materials/albedo_series.h"

namespace orrery {

// Albedo E(mu) of GGX microfacets of one alpha that mirror all light once: the share of light at a cosine mu
// that leaves without a second facet hit. The scale is alpha. The error is below 1e-3 for mu > 0.01.
template <class N>
using GgxAlbedo = AlbedoSeries<N, 14>;

// Returns the albedo, interpolated in a table that is made once by quadrature. REQUIRES: 0 < alpha <= 1.
GgxAlbedo<double> ggx_albedo(double alpha);

}  // namespace orrery
