#include "core/lights/attenuation.h"

#include "core/params/params.h"

namespace orrery {

Attenuation<double> read_attenuation(Params& p) {
  const auto c =
      p.numbers3("attenuation", "Coefficients c0, c1, c2 of min(1 / (c0 + c1 d + c2 d^2), 1), d in metres.",
                 {.min = 0, .max = 1e12}, Vec3d(1, 0, 0));
  if (c[0] == 0 && c[1] == 0 && c[2] == 0)
    p.fail("attenuation", "must have at least one coefficient > 0 (got [0,0,0])");
  constexpr double kUnlimited = 1e12;
  const bool limited =
      p.flag("clamp_to_one",
             "Limit the attenuation factor to 1. If false, [0, 0, 1] gives the inverse-square law of "
             "a physical point light.",
             true);
  return {c[0], c[1], c[2], limited ? 1 : kUnlimited};
}

}  // namespace orrery
