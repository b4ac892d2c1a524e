#pragma once

#include <array>

#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/render/halves.h"
#include "core/render/sampled_error.h"

namespace orrery {

// Samples of one tile: sums by channel and slot of the first half, and of all. Values that are not finite are
// left out, and are reported elsewhere. Results are bit-identical at each SIMD level. REQUIRES: an even
// number of samples.
struct TileHalves {
  const TileView& tile;
  const std::array<TileSums::Plane, 3>&first, &all;
  int samples;  // in `all`

  SampledError error() const;
  // Adds the differences of radiance, relative to the range of a sample.
  void add_to(Halves& halves, const Plan& plan) const;
  // Adds the differences of displayed values.
  void add_displayed_to(Halves& halves, const Plan& plan) const;
};

}  // namespace orrery
