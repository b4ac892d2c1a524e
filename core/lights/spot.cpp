#include "core/lights/spot.h"

#include "core/lights/light_set.h"
#include "core/math/angles.h"
#include "core/params/params.h"

namespace orrery {

template <class N>
Spot<double> Spot<N>::read(Params& p) {
  constexpr Range kHalfAngle = {.min = 0, .max = 180};
  const Vec3d position = p.point("position", "Position of the light, in metres.");
  const Vec3d direction = p.direction("direction", "Direction of the beam.");
  const Vec3d intensity = p.color(
      "intensity", "Intensity; a white surface that faces a light of intensity 1 has radiance 1.", Vec3d(1));
  const Attenuation<double> attenuation = read_attenuation(p);
  const double inner =
      p.number("inner_degrees", "Half angle of the full-intensity beam, in degrees.", kHalfAngle, 15.0);
  const double outer =
      p.number("outer_degrees", "Half angle at which the beam ends, in degrees.", kHalfAngle, 30.0);
  if (inner > outer)
    p.fail("inner_degrees",
           "must be at most outer_degrees, " + number_text(outer) + " (got " + number_text(inner) + ")");
  const double cos_inner = sine_cosine_degrees(inner).cosine, cos_outer = sine_cosine_degrees(outer).cosine;
  return {position, direction, intensity, attenuation, cos_inner, cos_outer, cos_inner - cos_outer};
}

// Cosines of directions have an error of about one epsilon. The smooth step multiplies this error by at most
// 1.5 / width.
template <class N>
RoundingLimit Spot<N>::rounding() const {
  constexpr double kMaxError = 2e-4;
  const double width = cos_range > 0 ? cos_range : 1 - cos_outer;
  return {kMaxError * width, "the edge of the beam spans only " + number_text(width) + " in cosine"};
}

LightType spot_type() { return {"spot", "A point light that shines into a cone.", make_light_set<Spot>}; }

}  // namespace orrery
