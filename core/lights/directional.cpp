#include "core/lights/directional.h"

#include "core/lights/light_set.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Directional<double> Directional<N>::read(Params& p) {
  const Vec3d from = p.direction("from", "Direction toward the light.");
  return {from, p.color("intensity", "A white surface that faces intensity 1 reads 1.", Vec3d(1))};
}

LightType directional_type() {
  return {"directional", "Parallel light from infinitely far away.", make_light_set<Directional>};
}

}  // namespace orrery
