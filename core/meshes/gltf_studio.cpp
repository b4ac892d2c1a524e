#include "core/meshes/gltf_studio.h"

#include <cmath>
#include <numbers>

#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kMaxCameras = 1000, kMaxLights = 1000;  // the first ones are read

double number_in(const GltfValue& value, double least, double most) {
  const double number = value.number();
  if (!(number > least && number < most))
    value.fail("must be greater than " + text_of(least) + " and less than " + text_of(most) + " (got " +
               text_of(number) + ")");
  return number;
}

std::string name_or(const GltfValue& object, const std::string& fallback) {
  const auto name = object.find("name");
  return name && !name->text().empty() ? name->text() : fallback;
}

// Cameras look along -z, and +y is up.
void add_camera(const GltfValue& camera, const Affined& world_from_node, MeshModel& model) {
  constexpr double kMaxHeight = 1e12;
  ModelCamera found;
  found.name = name_or(camera, std::to_string(model.cameras.size()));
  found.eye = world_from_node.point(Vec3d(0));
  found.direction = safe_normalize(world_from_node.vector({0, 0, -1}));
  found.up = safe_normalize(world_from_node.vector({0, 1, 0}));
  if (found.direction == Vec3d() || found.up == Vec3d() || !is_position(found.eye))
    camera.fail("node of a camera must have a transform without zero scale");
  const GltfValue type = camera.at("type");
  if (type.text() == "perspective")
    found.fov_degrees = number_in(camera.at("perspective").at("yfov"), 0, std::numbers::pi) * kDegrees;
  else if (type.text() == "orthographic")
    found.height = 2 * number_in(camera.at("orthographic").at("ymag"), 0, kMaxHeight);
  else
    type.fail("must be perspective or orthographic (got " + excerpt(type.text()) + ")");
  model.cameras.push_back(std::move(found));
}

// Lights shine along -z.
void add_light(const GltfValue& light, const Affined& world_from_node, MeshModel& model) {
  constexpr double kMaxIntensity = 1e12;
  ModelLight found;
  const GltfValue type = light.at("type");
  if (type.text() == "directional")
    found.kind = ModelLight::Kind::directional;
  else if (type.text() == "point")
    found.kind = ModelLight::Kind::point;
  else if (type.text() == "spot")
    found.kind = ModelLight::Kind::spot;
  else
    type.fail("must be directional, point or spot (got " + excerpt(type.text()) + ")");
  found.position = world_from_node.point(Vec3d(0));
  found.direction = safe_normalize(world_from_node.vector({0, 0, -1}));
  if (found.direction == Vec3d() || !is_position(found.position))
    light.fail("node of a light must have a transform without zero scale");
  const auto intensity = light.find("intensity");
  Vec3d color(1);
  if (const auto list = light.find("color"))
    color = {number_in(list->item(0), -1e-9, kMaxIntensity), number_in(list->item(1), -1e-9, kMaxIntensity),
             number_in(list->item(2), -1e-9, kMaxIntensity)};
  found.intensity = largest(color, Vec3d(0)) * (intensity ? number_in(*intensity, -1e-9, kMaxIntensity) : 1);
  if (const auto spot = light.find("spot")) {
    if (const auto inner = spot->find("innerConeAngle"))
      found.inner_degrees = number_in(*inner, -1e-9, std::numbers::pi / 2) * kDegrees;
    if (const auto outer = spot->find("outerConeAngle"))
      found.outer_degrees = number_in(*outer, 0, std::numbers::pi / 2 + 1e-9) * kDegrees;
    found.inner_degrees = std::min(std::max(found.inner_degrees, 0.0), found.outer_degrees);
  }
  model.lights.push_back(std::move(found));
}

}  // namespace

void add_gltf_studio(const GltfValue& root, const GltfValue& node, const Affined& world_from_node,
                     MeshModel& model) {
  if (const auto camera = node.find("camera"); camera && model.cameras.size() < kMaxCameras)
    add_camera(root.at("cameras").item(camera->integer()), world_from_node, model);
  const auto extensions = node.find("extensions");
  const auto punctual = extensions ? extensions->find("KHR_lights_punctual") : std::nullopt;
  if (!punctual || model.lights.size() >= kMaxLights) return;
  const GltfValue lights = root.at("extensions").at("KHR_lights_punctual").at("lights");
  add_light(lights.item(punctual->at("light").integer()), world_from_node, model);
}

}  // namespace orrery
