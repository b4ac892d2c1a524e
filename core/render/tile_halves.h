#pragma once

#include <array>

#include "core/model/film.h"
#include "core/model/plan.h"
#include "core/render/halves.h"
#include "core/render/sampled_error.h"

namespace orrery {

// The samples of one tile, of which there are an even number, and the first half of them: sums by channel and
// slot. What they tell of the error leaves out values that are not finite, which are told besides. The same
// bits at each machine level.
struct TileHalves {
  const TileView& tile;
  const std::array<TileSums::Plane, 3>&first, &all;
  int samples;  // of all

  SampledError error() const;
  // By how much radiance differs, over what a sample of the plan's may differ by.
  void add_to(Halves& halves, const Plan& plan) const;
  // By how much what a display shows differs.
  void add_displayed_to(Halves& halves, const Plan& plan) const;
};

}  // namespace orrery
