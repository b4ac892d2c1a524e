#pragma once

#include <limits>

#include "core/lights/arrival.h"
#include "core/model/light.h"

namespace orrery {

// Parallel light from infinitely far away.
template <class N>
struct Directional {
  Vec3<N> from, intensity;

  static constexpr LightTraits kTraits = {.delta = true, .parallel = true};
  static Directional<double> read(Params& p);

  Arrival<N> arrive(const Vec3<N>&) const {
    return {from, N(std::numeric_limits<ScalarOf<N>>::infinity()), intensity};
  }
};

}  // namespace orrery
