#include "tests/povray/povray_scene.h"

#include <map>
#include <numbers>

#include "tests/povray/povray_text.h"

namespace orrery {
namespace {

using povray::Json;
using povray::text;
using povray::vector_of;

// All vectors are explicit, so that POV-Ray's left-handed defaults do not apply. `right` points to the right
// of the image. The lengths of `right` and `up` are the width and height of the image plane at the end of
// `direction`.
std::string camera_of(const Json& camera, double aspect) {
  const Vec3d eye = vector_of(camera, "eye");
  const Vec3d forward = normalize(vector_of(camera, "look_at") - eye);
  const Vec3d right = normalize(cross(forward, vector_of(camera, "up", {0, 1, 0})));
  const Vec3d up = cross(right, forward);
  const bool perspective = camera.at("type") == "perspective";
  const double half_angle = camera.value("fov_degrees", 45.0) / 2 * std::numbers::pi / 180;
  const double height = perspective ? 2 * std::tan(half_angle) : camera.at("height").get<double>();
  return "camera {\n  " + std::string(perspective ? "perspective" : "orthographic") + "\n  location " +
         text(eye) + "\n  direction " + text(forward) + "\n  up " + text(up * height) + "\n  right " +
         text(right * (height * aspect)) + "\n}\n";
}

std::string settings_of(const Json& scene, const PovrayOptions& options) {
  const Vec3d ambient = vector_of(scene, "ambient", Vec3d()) * options.exposure;
  const Vec3d background = vector_of(scene, "background", Vec3d()) * options.exposure;
  // adc_bailout 0 traces rays of any weight. Camera rays have depth 0 in Orrery and trace level 1 in POV-Ray.
  return "#version 3.7;\nglobal_settings {\n  assumed_gamma 1\n  adc_bailout 0\n  max_trace_level " +
         std::to_string(options.max_depth + 1) + "\n  ambient_light rgb " + text(ambient) +
         "\n}\nbackground { rgb " + text(background) + " }\n";
}

std::string fog_of(const Json& atmosphere, double exposure) {
  return "fog { fog_type 1 distance " + text(atmosphere.at("mean_free_path").get<double>()) + " color rgb " +
         text(vector_of(atmosphere, "color") * exposure) + " }\n";
}

// In Orrery, glass casts the shadow of an opaque body. In POV-Ray, light passes straight through glass. The
// export therefore disables the shadow of glass and adds an invisible black body that casts it.
std::string object_of(const Json& object, const povray::Material& material) {
  const std::string shape = povray::shape_of(object);
  if (!material.transparent) return shape + material.modifiers + "}\n";
  return shape + material.modifiers + "no_shadow }\n" + shape +
         "pigment { rgb 0 } finish { ambient 0 diffuse 0 } no_image no_reflection }\n";
}

}  // namespace

std::string povray_scene(const Json& scene, const PovrayOptions& options) {
  std::string out = settings_of(scene, options) + camera_of(scene.at("camera"), options.aspect);
  if (scene.contains("atmosphere")) out += fog_of(scene.at("atmosphere"), options.exposure);
  for (const Json& light : scene.value("lights", Json::array()))
    out += povray::light_of(light, options.exposure);
  std::map<std::string, povray::Material> materials;
  for (const auto& [name, material] : scene.at("materials").items())
    materials.emplace(name, povray::material_of(material, scene.value("textures", Json::object())));
  for (const Json& object : scene.at("objects"))
    out += object_of(object, materials.at(object.at("material")));
  for (const Json& instance : scene.value("instances", Json::array())) {
    out += "union {\n";
    for (const Json& object : scene.at("models").at(instance.at("model")).at("objects"))
      out += object_of(object, materials.at(object.at("material")));
    out += povray::placement_of(instance) + "}\n";
  }
  return out;
}

}  // namespace orrery
