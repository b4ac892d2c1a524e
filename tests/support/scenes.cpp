#include "tests/support/scenes.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "core/base/error.h"
#include "core/load/load.h"
#include "core/params/json.h"

namespace orrery::test {
namespace {

constexpr std::string_view kEmptyScene = R"({
  "version": 1,
  "camera": {"type": "perspective", "eye": [0, 0, 4], "look_at": [0, 0, 0]},
  "image": {"width": 64, "height": 64},
  "materials": {"white": {"type": "rough", "kd": 1}}
})";

// Keys of the scene format, by meaning.
const std::set<std::string> kPoints = {"translate", "eye", "look_at",  "center", "point", "base", "top",
                                       "min",       "max", "position", "corner", "from",  "to"};
const std::set<std::string> kSides = {"edge_u", "edge_v"};  // vectors with a length
const std::set<std::string> kPointLists = {"vertices", "positions", "points"};
const std::set<std::string> kLengths = {"radius",       "base_radius", "top_radius",      "major_radius",
                                        "minor_radius", "height",      "aperture_radius", "focus_distance",
                                        "front",        "back",        "mean_free_path"};
const std::set<std::string> kDirections = {"up", "axis", "normal", "direction", "direction_to_light"};
const std::set<std::string> kPerLength = {"intensity_per_metre"};  // colours that scale with lengths

using Change = std::function<void(const std::string& key, Json& value)>;

// Calls `change` for each key and value of `object` and of its motion.
void change_members(Json& object, const Change& change) {
  for (auto& [key, value] : object.items()) {
    change(key, value);
    if (key == "motion")
      for (Json& moment : value) change_members(moment, change);
  }
}

// Calls `change` for the members of the camera, the objects, the lights and the instances of a scene.
void change_places(Json& scene, const Change& change) {
  for (const char* part : {"camera", "atmosphere"})
    if (scene.contains(part)) change_members(scene[part], change);
  for (const char* list : {"objects", "lights", "instances"})
    if (scene.contains(list))
      for (Json& entry : scene[list]) change_members(entry, change);
}

void change_points(const std::string& key, Json& value, const std::function<Vec3d(Vec3d)>& map) {
  if (kPoints.contains(key)) value = numbers(map(vector(value)));
  if (kPointLists.contains(key))
    for (Json& point : value) point = numbers(map(vector(point)));
}

Change scale_by(double factor) {
  return [factor](const std::string& key, Json& value) {
    change_points(key, value, [factor](const Vec3d& p) { return p * factor; });
    if (kLengths.contains(key)) value = value.get<double>() * factor;
    if (kSides.contains(key) || kPerLength.contains(key)) value = numbers(vector(value) * factor);
    if (key == "attenuation") {
      value[1] = value[1].get<double>() / factor;
      value[2] = value[2].get<double>() / factor / factor;
    }
  };
}

Change move_by(const Vec3d& offset) {
  return [offset](const std::string& key, Json& value) {
    change_points(key, value, [offset](const Vec3d& p) { return p + offset; });
  };
}

void mirror_rectangle(Json& object) {
  if (!object.contains("corner")) return;
  for (const std::string& side : kSides) object[side][0] = -object[side][0].get<double>();
  std::swap(object["edge_u"], object["edge_v"]);
}

void mirror_mesh(Json& object) {
  if (object.contains("vertices")) std::swap(object["vertices"][1], object["vertices"][2]);
  if (object.contains("indices"))
    for (Json& corners : object["indices"]) std::swap(corners[1], corners[2]);
  if (object.contains("normals"))
    for (Json& normal : object["normals"]) normal[0] = -normal[0].get<double>();
}

// Mirrors an instance. The rotation is reversed and its axis mirrored.
void mirror_instance(Json& instance) {
  const Vec3d scale = vector(instance.value("scale", Json{1, 1, 1}));
  instance["scale"] = numbers(Vec3d(-scale.x, scale.y, scale.z));
  if (instance.contains("motion"))
    for (Json& moment : instance["motion"]) {
      if (moment.contains("scale")) moment["scale"][0] = -moment["scale"][0].get<double>();
      if (moment.contains("degrees")) moment["degrees"] = -moment["degrees"].get<double>();
    }
  if (!instance.contains("rotate")) return;
  Json& turn = instance["rotate"];
  const Vec3d axis = vector(turn.value("axis", Json{0, 1, 0}));
  turn["axis"] = numbers(Vec3d(-axis.x, axis.y, axis.z));
  turn["degrees"] = -turn.value("degrees", 0.0);
}

// Multiplies a number or a list of numbers.
void scale_value(Json& value, double factor) {
  if (!value.is_array())
    value = value.get<double>() * factor;
  else
    for (Json& entry : value) entry = entry.get<double>() * factor;
}

// Scales the lengths of the mapping of a texture, including those that are missing.
void scale_mapping(Json& mapping, double factor) {
  const std::string type = mapping.value("type", "uv");
  const auto scale = [&](const char* key, const Json& fallback) {
    mapping[key] = mapping.value(key, fallback);
    scale_value(mapping[key], factor);
  };
  mapping["type"] = type;
  if (type != "uv") scale("origin", {0, 0, 0});
  if (type == "planar") scale("u_edge", {1, 0, 0});
  if (type == "planar") scale("v_edge", {0, 1, 0});
  if (type == "cylindrical") scale("height", 1);
  if (type == "solid") scale("size", 1);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string() + ": tests run in the repository root");
  return (std::stringstream() << in.rdbuf()).str();
}

}  // namespace

Json json(std::string_view text) {
  std::string quoted(text);
  std::replace(quoted.begin(), quoted.end(), '\'', '"');
  return Json::parse(quoted);
}

Json scene_with(const Json& objects, const Json& patch) {
  Json scene = json(kEmptyScene);
  scene["objects"] = objects.is_array() ? objects : Json::array({objects});
  if (patch.contains("camera") && patch["camera"].contains("type")) scene.erase("camera");
  scene.merge_patch(patch);
  for (Json& object : scene["objects"])
    if (!object.contains("material")) object["material"] = "white";
  return scene;
}

Json scene_of(std::string_view objects, std::string_view patch) {
  return scene_with(json(objects), json(patch));
}

std::shared_ptr<const Scene> load(const Json& scene) { return load_scene(document_of(scene)); }

std::string first_problem(const Json& scene) { return first_problem_in_text(scene.dump()); }

std::string first_problem_in_text(std::string_view text) {
  try {
    load_scene(text);
  } catch (const InputError& error) {
    return error.problems().front().pointer;
  }
  return "accepted";
}

Json sample(std::string_view name) { return Json::parse(text_of("scenes/" + std::string(name) + ".json")); }

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("scenes"))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

Json scaled(Json scene, double factor) {
  change_places(scene, scale_by(factor));
  if (scene.contains("models"))
    for (Json& model : scene["models"])
      for (Json& object : model["objects"]) change_members(object, scale_by(factor));
  if (scene.contains("textures"))
    for (Json& texture : scene["textures"])
      if (texture.contains("mapping")) scale_mapping(texture["mapping"], factor);
  for (Json& material : scene["materials"]) {
    if (material.contains("bump")) scale_value(material["bump"]["scale"], factor);
    if (material.contains("mean_free_path")) scale_value(material["mean_free_path"], factor);
  }
  return scene;
}

Json without_filters(Json scene) {
  for (Json& material : scene["materials"]) material.erase("filter");
  return scene;
}

Json moved(Json scene, const Vec3d& offset) {
  if (scene.contains("instances"))
    for (Json& instance : scene["instances"])
      if (!instance.contains("translate")) instance["translate"] = {0, 0, 0};
  change_places(scene, move_by(offset));
  return scene;
}

Json placed(Json object, double factor, const Vec3d& offset) {
  change_members(object, scale_by(factor));
  change_members(object, move_by(offset));
  return object;
}

Json mirrored(Json scene) {
  const auto flip = [](const Vec3d& v) { return Vec3d(-v.x, v.y, v.z); };
  change_places(scene, [&](const std::string& key, Json& value) {
    change_points(key, value, flip);
    if (kDirections.contains(key)) value = numbers(flip(vector(value)));
  });
  for (Json& object : scene["objects"]) {
    mirror_mesh(object);
    mirror_rectangle(object);
    if (object.contains("min")) std::swap(object["min"][0], object["max"][0]);
  }
  if (scene.contains("instances"))
    for (Json& instance : scene["instances"]) mirror_instance(instance);
  return scene;
}

Json numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec3d vector(const Json& three) {
  return {three[0].get<double>(), three[1].get<double>(), three[2].get<double>()};
}

}  // namespace orrery::test
