#pragma once

#include "core/math/lanes.h"
#include "core/math/vec3.h"
#include "core/params/params.h"

namespace orrery {

// Weakening with distance: f(d) = min(1 / (c0 + c1 d + c2 d^2), 1), in [0, 1] for every d >= 0.
class Attenuation {
 public:
  static Attenuation read(Params& p) {
    const auto c = p.numbers3("attenuation", "c0, c1, c2 of min(1 / (c0 + c1 d + c2 d^2), 1), d in metres.",
                              {.min = 0, .max = 1e12}, Vec3d(1, 0, 0));
    if (c[0] == 0 && c[1] == 0 && c[2] == 0) p.fail("attenuation", "expected at least one coefficient > 0");
    return Attenuation(c[0], c[1], c[2]);
  }

  template <class N>
  N at(const N& distance) const {
    using T = ScalarOf<N>;
    const N denominator = T(c0_) + distance * (T(c1_) + distance * T(c2_));
    return min_first(N(T(1)), N(T(1) / denominator));
  }

 private:
  Attenuation(double c0, double c1, double c2) : c0_(c0), c1_(c1), c2_(c2) {}
  double c0_, c1_, c2_;
};

}  // namespace orrery
