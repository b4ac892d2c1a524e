#include <algorithm>
#include <cmath>

#include "tests/povray/povray_scene.h"
#include "tests/povray/povray_text.h"

namespace orrery::povray {
namespace {

constexpr double kFarAway = 1e5;  // distance of a directional light, beyond every visible shadow

struct Fading {
  double factor;  // factor on the light's colour
  std::string keywords;
};

// A POV-Ray light fades as 2 / (1 + (d / distance)^power), an Orrery light as 1 / (c0 + c1 d + c2 d^2). The
// forms match if c1 or c2 is 0. Orrery limits attenuation to 1 and POV-Ray does not, so the two agree only
// where c0 + c1 d + c2 d^2 >= 1.
Fading fading_of(const Json& light) {
  const Vec3d c = vector_of(light, "attenuation", {1, 0, 0});
  if (c.y == 0 && c.z == 0) return {std::min(1.0, 1 / c.x), ""};
  if (c.x == 0 || (c.y != 0 && c.z != 0))
    throw UnsupportedFeature("cannot export attenuation: c0 must be > 0, and c1 or c2 must be 0");
  const double power = c.y != 0 ? 1 : 2;
  const double distance = c.y != 0 ? c.x / c.y : std::sqrt(c.x / c.z);
  return {0.5 / c.x, " fade_power " + text(power) + " fade_distance " + text(distance)};
}

// Between the two angles, POV-Ray's beam falls off as a smooth step in the cosine, as in Orrery. A tightness
// above 0 would narrow the beam.
std::string cone_of(const Json& light) {
  const Vec3d aim = vector_of(light, "position") + normalize(vector_of(light, "direction"));
  return " spotlight point_at " + text(aim) + " radius " + text(light.value("inner_degrees", 15.0)) +
         " falloff " + text(light.value("outer_degrees", 30.0)) + " tightness 0";
}

}  // namespace

std::string light_of(const Json& light, double exposure) {
  const std::string type = light.at("type");
  const Vec3d intensity = vector_of(light, "intensity", Vec3d(1)) * exposure;
  if (type == "directional")
    return "light_source { " + text(normalize(vector_of(light, "direction_to_light")) * kFarAway) + " rgb " +
           text(intensity) + " parallel point_at 0 }\n";
  if (type != "point" && type != "spot") throw UnsupportedFeature("cannot export light of type " + type);
  const Fading fading = fading_of(light);
  return "light_source { " + text(vector_of(light, "position")) + " rgb " + text(intensity * fading.factor) +
         (type == "spot" ? cone_of(light) : "") + fading.keywords + " }\n";
}

}  // namespace orrery::povray
