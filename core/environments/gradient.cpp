#include "core/environments/gradient.h"

#include "core/environments/formula.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Gradient<double> Gradient<N>::read(Params& p) {
  return {p.color("zenith", "Radiance from straight above, +y.", Vec3d(0.25, 0.45, 0.9)),
          p.color("horizon", "Radiance from where the sky ends.", Vec3d(0.8, 0.9, 1)),
          p.color("ground", "Radiance from everywhere below.", Vec3d(0.3, 0.28, 0.25))};
}

EnvironmentType gradient_type() {
  return {"gradient", "A sky from horizon to zenith, and ground.", read_formula<Gradient>};
}

}  // namespace orrery
