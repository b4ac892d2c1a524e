#pragma once

#include <array>

#include "core/accuracy/halves.h"
#include "core/accuracy/sampled_error.h"
#include "core/model/film.h"
#include "core/model/plan.h"

namespace orrery {

// Sums over the first half of the samples of one tile, and over all samples, by channel and pixel. Skips
// non-finite values, which FilmError::non_finite_pixels counts. Results are bit-identical at each SIMD level.
// REQUIRES: `samples` is even.
struct TileHalves {
  const TileView& tile;
  const std::array<TileSums::Plane, 3>&first, &all;
  int samples;  // number of samples in `all`

  SampledError error() const;
  // Adds the differences in radiance, relative to Plan::sample_range.
  void add_to(Halves& halves, const Plan& plan) const;
  // Adds the differences in display values (sRGB-encoded, 0 to 1).
  void add_displayed_to(Halves& halves, const Plan& plan) const;
};

}  // namespace orrery
