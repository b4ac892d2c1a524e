#include "core/lights/directional.h"

#include "core/lights/light_set.h"
#include "core/math/angles.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Directional<double> Directional<N>::read(Params& p) {
  const Vec3d from = p.direction("direction_to_light", "Direction toward the light.");
  const Vec3d intensity = p.color(
      "intensity", "Intensity; a white surface that faces a light of intensity 1 has radiance 1.", Vec3d(1));
  const double angle =
      p.number("angle_degrees",
               "Angular diameter of the disc in degrees, for path and distributed; sun: 0.53; parallel: 0.",
               {.min = 0, .max = 180}, 0.0);
  const double sine = sine_cosine_degrees(angle / 4).sine;
  return {from, intensity, 2 * sine * sine};
}

LightType directional_type() {
  return {"directional", "A light at infinite distance, parallel or from a disc.",
          make_light_set<Directional>};
}

}  // namespace orrery
