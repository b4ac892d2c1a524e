#pragma once

#include "core/atmospheres/formula.h"
#include "core/math/elementary.h"

namespace orrery {

// Homogeneous fog: the share of light that remains after d metres is exp(-d / mean_free_path) (Beer and
// Lambert), and light of the fog's own radiance replaces the rest.
template <class N>
struct Fog {
  static constexpr const char* kName = "fog";
  static constexpr bool kAlongAllRays = true, kHidesBackground = true;

  Vec3<N> color;
  N log2_rate;  // log2 of the share per metre, negative

  static Fog<double> read(Params& p);

  [[gnu::always_inline]] N share(const N& distance, const N&) const {
    return exp2_flushed(N(distance * log2_rate));
  }
};

}  // namespace orrery
