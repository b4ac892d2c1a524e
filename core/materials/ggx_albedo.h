#pragma once

#include "core/materials/albedo_series.h"

namespace orrery {

// Albedo E(mu) of GGX microfacets of one alpha that mirror all light once: the share of light at a cosine mu
// that they reflect without passing it on to each other. Its scale is alpha: within 1e-3 (mu > 0.01).
template <class N>
using GgxAlbedo = AlbedoSeries<N, 14>;

// By interpolation in a table made once by quadrature. REQUIRES: 0 < alpha <= 1.
GgxAlbedo<double> ggx_albedo(double alpha);

}  // namespace orrery
