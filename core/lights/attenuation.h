#pragma once

#include "core/math/lanes.h"
#include "core/math/vec3.h"

namespace orrery {

class Params;

// Distance attenuation f(d) = min(1 / (c0 + c1 d + c2 d^2), most), d >= 0 in metres. With clamp_to_one,
// `most` is 1. Otherwise it is 1e12 and only keeps values finite.
template <class N>
struct Attenuation {
  N c0, c1, c2, most;

  N at(const N& distance) const {
    using T = ScalarOf<N>;
    const N denominator = c0 + distance * (c1 + distance * c2);
    return min_first(most, N(T(1) / denominator));
  }
};

Attenuation<double> read_attenuation(Params& p);

}  // namespace orrery
