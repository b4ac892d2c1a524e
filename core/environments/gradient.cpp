#include "core/environments/gradient.h"

#include "core/environments/formula.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Gradient<double> Gradient<N>::read(Params& p) {
  return {p.color("zenith", "Radiance from straight above (+y).", Vec3d(0.25, 0.45, 0.9)),
          p.color("horizon", "Radiance from the horizon.", Vec3d(0.8, 0.9, 1)),
          p.color("ground", "Radiance from all directions below the horizon.", Vec3d(0.3, 0.28, 0.25))};
}

EnvironmentType gradient_type() {
  return {"gradient", "A sky gradient from horizon to zenith over uniform ground.", read_formula<Gradient>};
}

}  // namespace orrery
