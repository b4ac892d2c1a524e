#include "core/lights/point.h"

#include "core/lights/light_set.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
PointLight<double> PointLight<N>::read(Params& p) {
  const Vec3d position = p.point("position", "Where the light is, in metres.");
  const Vec3d intensity = p.color("intensity", "A white surface that faces intensity 1 reads 1.", Vec3d(1));
  return {position, intensity, read_attenuation(p)};
}

LightType point_type() {
  return {"point", "Light from one point in all directions.", make_light_set<PointLight>};
}

}  // namespace orrery
