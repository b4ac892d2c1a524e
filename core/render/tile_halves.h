#pragma once

#include <array>

#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/render/halves.h"
#include "core/render/sampled_error.h"

namespace orrery {

// Sums of the samples of one tile by channel and pixel: of the first half, and of all. Non-finite values are
// skipped; FilmError::non_finite_pixels counts them. Results are bit-identical at each SIMD level. REQUIRES:
// an even number of samples.
struct TileHalves {
  const TileView& tile;
  const std::array<TileSums::Plane, 3>&first, &all;
  int samples;  // in `all`

  SampledError error() const;
  // Adds the differences in radiance, relative to the range of a sample.
  void add_to(Halves& halves, const Plan& plan) const;
  // Adds the differences in display values (sRGB-encoded, 0 to 1).
  void add_displayed_to(Halves& halves, const Plan& plan) const;
};

}  // namespace orrery
