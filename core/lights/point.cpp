#include "core/lights/point.h"

#include "core/lights/light_set.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
PointLight<double> PointLight<N>::read(Params& p) {
  const Vec3d position = p.point("position", "Position of the light, in metres.");
  const Vec3d intensity = p.color(
      "intensity", "Intensity; a white surface that faces a light of intensity 1 has radiance 1.", Vec3d(1));
  return {position, intensity, read_attenuation(p)};
}

LightType point_type() {
  return {"point", "A point light that shines in all directions.", make_light_set<PointLight>};
}

}  // namespace orrery
