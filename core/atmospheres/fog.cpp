#include "core/atmospheres/fog.h"

#include <numbers>

#include "core/params/params.h"

namespace orrery {

template <class N>
Fog<double> Fog<N>::read(Params& p) {
  const Vec3d color = p.color("color", "Radiance of the fog, which replaces the background.", Vec3d(0.8));
  const double path =
      p.positive("mean_free_path", "Distance after which 1/e of the light remains, in metres.");
  return {color, -std::numbers::log2e / path};
}

AtmosphereType fog_type() {
  return {Fog<double>::kName, "Homogeneous fog: absorbs light exponentially along every ray outside objects.",
          read_atmosphere<Fog>};
}

}  // namespace orrery
