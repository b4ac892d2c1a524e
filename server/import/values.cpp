#include "server/import/values.h"

#include <algorithm>
#include <cmath>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/spectrum.h"

namespace orrery {

SceneJson color_json(SceneWriter& scene, const ImportValue& value, double most) {
  if (value.is_constant()) return scene.color(value.mean(), most);
  SceneJson json{{"texture", value.texture}};
  const SceneJson tint = scene.color(value.factor, most);
  if (!(value.factor == Vec3d(1))) json["tint"] = tint;
  if (value.inverted) {
    json["scale"] = -1;
    json["offset"] = 1;
  }
  return json;
}

SceneJson number_json(SceneWriter& scene, const ImportValue& value, double least, double most) {
  const double number = luminance_of(value.factor);
  if (value.is_constant()) {
    const double constant = value.inverted ? 1 - number : number;
    if (!(constant >= least && constant <= most))
      scene.notes().add("number outside of " + number_text(least) + " to " + number_text(most) +
                        " is clamped");
    return std::clamp(constant, least, most);
  }
  SceneJson json{{"texture", value.texture}};
  if (number != 1 || value.inverted) json["scale"] = value.inverted ? -number : number;
  if (value.inverted) json["offset"] = 1;
  return json;
}

void add_metal(SceneWriter& scene, SceneJson& material, const std::string& symbol) {
  const NamedMetal* metal = metal_named(symbol);
  if (metal == nullptr) {
    scene.notes().add("metal " + excerpt(symbol) + " is replaced by aluminium");
    metal = metal_named("Al");
  }
  if (!metal->orrery_name.empty()) {
    material["name"] = metal->orrery_name;
  } else {
    material["n"] = scene.color(metal->n);
    material["k"] = scene.color(metal->k);
  }
}

SceneJson extinction_json(SceneWriter& scene, const Vec3d& reflectance) {
  const auto k = [](double r) {
    const double clamped = std::clamp(r, 0.0, 0.9999);
    return 2 * std::sqrt(clamped / (1 - clamped));
  };
  return scene.color({k(reflectance.x), k(reflectance.y), k(reflectance.z)});
}

SceneJson pane_json(SceneWriter& scene, double ior) {
  scene.notes().add("thin dielectric is a pane without reflections");
  const double r = std::pow((ior - 1) / (ior + 1), 2);
  return {{"type", "transparent"}, {"blend", "filtered"}, {"kt", (1 - r) / (1 + r)}, {"kd", 0}, {"ka", 0}};
}

}  // namespace orrery
