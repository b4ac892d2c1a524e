#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/angles.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/environment.h"
#include "server/import/pbrt_scene.h"

// pbrt-v4 divides every light by the luminance of its spectrum, so "scale" is in nits, candela or lux and
// "rgb" multiplies white light of that luminance (pbrt-v4, src/pbrt/lights.cpp). Its film stores radiance.
// Irradiance E makes a white surface as bright as E / pi, so the intensity of point, spot and distant lights
// of scenes is that of pbrt divided by pi.
namespace orrery {
namespace {

constexpr double kPi = std::numbers::pi;

// Returns the colour of a light, times its scale and the exposure.
Vec3d light_scale(const PbrtScene& pbrt, const PbrtParameters& p, std::string_view name) {
  return p.light_color(name, pbrt.spectra).value_or(Vec3d(1)) * (p.number("scale", 1) * pbrt.exposure);
}

// Returns the factor of a light that states its power in lumens, or illuminance in lux: that value divided by
// the one at a scale of 1. Then "scale" multiplies it.
double photometric(const PbrtParameters& p, std::string_view name, double at_scale_1) {
  const double asked = p.number(name, -1);
  return asked > 0 ? asked / at_scale_1 : 1;
}

// Adds the keys of lights with inverse-square falloff.
void add_falloff(SceneJson& light) {
  light["attenuation"] = {0, 0, 1};
  light["clamp_to_one"] = false;
}

SceneJson point_light(PbrtScene& pbrt, const PbrtParameters& p, const Affined& map) {
  const Vec3d color = light_scale(pbrt, p, "I") * (photometric(p, "power", 4 * kPi) / kPi);
  SceneJson light{{"type", "point"},
                  {"position", pbrt.scene.point(map.point(p.point("from", {})))},
                  {"intensity", pbrt.scene.color(color)}};
  add_falloff(light);
  return light;
}

SceneJson spot_light(PbrtScene& pbrt, const PbrtParameters& p, const Affined& map, double cone) {
  const auto checked = [&](std::string_view name, double fallback) {
    const double degrees = p.number(name, fallback);
    if (!(degrees >= 0 && degrees <= 180))
      refuse_at(p.place(),
                std::string(name) + " must be from 0 to 180 degrees (got " + number_text(degrees) + ")");
    return degrees;
  };
  const double outer = checked("coneangle", cone),
               inner = std::max(0.0, outer - checked("conedeltaangle", 5));
  const double cos_outer = sine_cosine_degrees(outer).cosine, cos_inner = sine_cosine_degrees(inner).cosine;
  const double at_scale_1 = 2 * kPi * ((1 - cos_inner) + (cos_inner - cos_outer) / 2);
  const Vec3d color = light_scale(pbrt, p, "I") * (photometric(p, "power", at_scale_1) / kPi);
  const Vec3d from = p.point("from", {}), to = p.point("to", {0, 0, 1});
  if (from == to) refuse_at(p.place(), "from and to of a spot light must differ");
  SceneJson light{{"type", "spot"},
                  {"position", pbrt.scene.point(map.point(from))},
                  {"direction", pbrt.scene.direction(map.vector(to - from))},
                  {"intensity", pbrt.scene.color(color)},
                  {"inner_degrees", inner},
                  {"outer_degrees", outer}};
  add_falloff(light);
  return light;
}

SceneJson distant_light(PbrtScene& pbrt, const PbrtParameters& p, const Affined& map) {
  const Vec3d color = light_scale(pbrt, p, "L") * (photometric(p, "illuminance", 1) / kPi);
  const Vec3d from = p.point("from", {}), to = p.point("to", {0, 0, 1});
  if (from == to) refuse_at(p.place(), "from and to of a distant light must differ");
  return {{"type", "directional"},
          {"direction_to_light", pbrt.scene.direction(map.vector(from - to))},
          {"intensity", pbrt.scene.color(color)}};
}

void add_infinite(PbrtScene& pbrt, const PbrtParameters& p, const Affined& map) {
  p.ignore({"portal"});
  const std::string file = p.text("filename", p.text("mapname", ""));
  const Vec3d color = light_scale(pbrt, p, "L");
  if (file.empty()) return add_constant_environment(pbrt.scene, color * photometric(p, "illuminance", kPi));
  if (p.find("illuminance") != nullptr)
    pbrt.notes().add("illuminance of an image of the surroundings is left out");
  add_image_environment(pbrt.scene, pbrt.nearby, file, EnvironmentLayout::pbrt, map, color);
}

}  // namespace

void add_pbrt_light(PbrtScene& pbrt, const std::string& type, const PbrtParameters& p, const Affined& map) {
  pbrt.scene.at(p.place());
  if (type == "infinite") {
    add_infinite(pbrt, p, map);
  } else if (type == "point") {
    pbrt.scene.add_light(point_light(pbrt, p, map));
  } else if (type == "spot") {
    pbrt.scene.add_light(spot_light(pbrt, p, map, 30));
  } else if (type == "distant") {
    pbrt.scene.add_light(distant_light(pbrt, p, map));
  } else if (type == "goniometric") {
    pbrt.notes().add("goniometric light is replaced by a point light");
    pbrt.scene.add_light(point_light(pbrt, p, map));
  } else if (type == "projection") {
    pbrt.notes().add("projection light is replaced by a spot light");
    pbrt.scene.add_light(spot_light(pbrt, p, map, p.number("fov", 90) / 2));
  } else {
    refuse_at(p.place(), "type of a light must be one of pbrt's, such as point (got " + excerpt(type) + ")");
  }
  p.note_unused(pbrt.notes(), "light " + excerpt(type));
}

SceneJson pbrt_emission(PbrtScene& pbrt, const PbrtParameters& light, double area) {
  const double sides = light.flag("twosided", false) ? 2 : 1;
  const Vec3d color = light_scale(pbrt, light, "L") * photometric(light, "power", sides * kPi * area);
  const std::string file = light.text("filename", "");
  light.note_unused(pbrt.notes(), "area light");
  if (file.empty()) return pbrt.scene.color(color);
  ImportValue value{color, pbrt_image(pbrt, file, "srgb", PbrtParameters())};
  if (value.is_constant()) value.factor = color * 0.5;
  return color_json(pbrt.scene, value, 1e6);
}

}  // namespace orrery
