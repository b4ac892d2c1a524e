#include "server/import/scene_writer.h"

#include <algorithm>

#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "core/plan/limits.h"
#include "server/import/mesh_writer.h"

namespace orrery {
namespace {

// A scene has at most 1,000,000 JSON values. Each vertex and triangle takes four.
constexpr std::size_t kInlineMesh = 1'000, kInlineMeshes = 150'000;
constexpr std::size_t kMaxNameBytes = 100;

SceneJson instance_json(const std::string& model, const InstanceParts& placement) {
  SceneJson json{{"model", model}};
  const auto numbers = [](const Vec3d& v) { return SceneJson{v.x, v.y, v.z}; };
  if (!(placement.scale == Vec3d(1))) json["scale"] = numbers(placement.scale);
  if (placement.degrees != 0)
    json["rotate"] = {{"axis", numbers(placement.axis)}, {"degrees", placement.degrees}};
  if (!(placement.translate == Vec3d(0.0))) json["translate"] = numbers(placement.translate);
  return json;
}

}  // namespace

SceneWriter::SceneWriter(const ImportOptions& options) : options_(options) {
  scene_ = {{"version", 1}, {"title", ""}, {"camera", nullptr}, {"image", nullptr}};
}

std::string SceneWriter::free_name(Named& named, const std::string& wanted) {
  const std::string start = wanted.empty() ? "unnamed" : shortened(as_utf8(wanted), kMaxNameBytes);
  std::string name = start;
  for (int& k = named.used[start]; !named.names.try_emplace(name, true).second;)
    name = start + " " + std::to_string(++k + 1);
  return name;
}

std::string SceneWriter::name_of(Named& named, const char* key, const std::string& wanted, SceneJson value) {
  std::string content = value.dump(-1, ' ', false, SceneJson::error_handler_t::replace);
  const auto known = named.by_content.find(content);
  if (known != named.by_content.end()) return known->second;
  if (named.by_content.size() >= limits().definitions)
    refuse("scene must have at most " + grouped(limits().definitions) + " different " + key + " (got more)");
  std::string name = free_name(named, wanted);
  named.by_content.emplace(std::move(content), name);
  // The name is new. operator[] would search all names for it.
  if (!scene_.contains(key)) scene_[key] = SceneJson::object();
  SceneJson::object_t::Container& members = scene_[key].get_ref<SceneJson::object_t&>();
  members.emplace_back(name, std::move(value));
  return name;
}

std::string SceneWriter::material(const std::string& wanted, SceneJson material) {
  return name_of(materials_, "materials", wanted, std::move(material));
}

std::string SceneWriter::texture(const std::string& wanted, SceneJson texture) {
  if (textures_.by_content.size() >= static_cast<std::size_t>(kMaxTextures) &&
      !textures_.by_content.contains(texture.dump(-1, ' ', false, SceneJson::error_handler_t::replace))) {
    notes_.add("texture past the limit of " + std::to_string(kMaxTextures) + " is replaced by grey");
    return {};
  }
  return name_of(textures_, "textures", wanted, std::move(texture));
}

void SceneWriter::add_light(SceneJson light) {
  SceneJson& lights = scene_["lights"];
  if (lights.size() >= static_cast<std::size_t>(kMaxLights))
    refuse("scene must have at most " + grouped(static_cast<std::uint64_t>(kMaxLights)) +
           " lights (got more)");
  lights.push_back(std::move(light));
}

void SceneWriter::count_object() {
  checkpoint();
  if (++objects_ > limits().objects)
    refuse("scene must have at most " + grouped(limits().objects) + " objects and instances (got more)");
}

void SceneWriter::add_object(SceneJson object) {
  count_object();
  group().objects.push_back(std::move(object));
}

void SceneWriter::add_placed(SceneJson object, const Affined& map) {
  if (is_identity(map)) return add_object(std::move(object));
  count_object();
  const std::string wanted =
      object.contains("file") ? object["file"].get<std::string>() : object["type"].get<std::string>();
  std::string model = model_of(SceneJson::array({std::move(object)}), wanted);
  if (open_ != nullptr)
    open_->placed.emplace_back(std::move(model), map);
  else
    write_instance(model, map);
}

void SceneWriter::add_mesh(const TriangleMesh& mesh, const std::string& material) {
  const std::size_t values = mesh.positions.size() + mesh.triangles.size();
  vertices_ += values;
  if (vertices_ > limits().mesh_vertices)
    refuse("meshes of the description must have at most " + grouped(limits().mesh_vertices) +
           " vertices and triangles (got more)");
  for (const Vec3d& p : mesh.positions) point(p);  // checks the range
  SceneJson object{{"type", "mesh"}, {"material", material}};
  if (values <= kInlineMesh && inline_values_ + values <= kInlineMeshes) {
    inline_values_ += values;
    add_mesh_keys(object, mesh);
  } else {
    if (!writes_files())
      refuse("meshes of more than " + grouped(kInlineMesh) + " vertices and triangles, or of " +
             grouped(kInlineMeshes) + " together, are written to files; name the scene with --output (got " +
             grouped(values) + ")");
    object["file"] = add_file(".ply", ply_of(mesh));
  }
  add_object(std::move(object));
}

std::string SceneWriter::add_file(const std::string& ending, std::string bytes) {
  files_.push_back({options_.file_stem + std::to_string(files_.size() + 1) + ending, std::move(bytes)});
  return files_.back().name;
}

void SceneWriter::begin_model(const std::string& name) {
  if (groups_.size() >= limits().definitions)
    refuse("scene must define at most " + grouped(limits().definitions) + " objects (got more)");
  group_models_.erase(name);
  open_ = &groups_.insert_or_assign(name, Group()).first->second;
}

void SceneWriter::end_model() { open_ = nullptr; }

std::string SceneWriter::model_of(SceneJson objects, const std::string& wanted) {
  return name_of(models_, "models", wanted, {{"objects", std::move(objects)}});
}

void SceneWriter::add_instance(const std::string& name, const Affined& map) {
  const Group& group = groups_.at(name);
  if (!group.objects.empty()) {
    count_object();
    std::string& model = group_models_[name];
    if (model.empty()) model = model_of(group.objects, name);
    write_instance(model, map);
  }
  for (const auto& [model, inner] : group.placed) {
    count_object();
    write_instance(model, compose(map, inner));
  }
}

void SceneWriter::write_instance(const std::string& model, const Affined& map) {
  if (scaled_determinant(map) == 0) {
    notes_.add("object or instance with a scale of 0 is left out");
    return;
  }
  std::optional<InstanceParts> placement = instance_parts(map);
  if (!placement) {
    notes_.add("shear of an instance is left out");
    placement = nearest_instance_parts(map);
  }
  point(placement->translate);
  for (const double factor : {placement->scale.x, placement->scale.y, placement->scale.z})
    if (!(std::abs(factor) >= 1e-6 && std::abs(factor) <= 1e6))
      refuse("scale of an instance must be from 1e-6 to 1e6 (got " + number_text(std::abs(factor)) + ")");
  scene_["instances"].push_back(instance_json(model, *placement));
}

std::string SceneWriter::file_name(const std::string& name) const {
  if (name.empty()) refuse("name of a file must not be empty");
  if (name.starts_with('/') || name.find('\0') != name.npos || as_utf8(name) != name)
    refuse("name of a file must be relative to the scene, in UTF-8 (got " + excerpt(name, 80) + ")");
  if (!options_.folder)
    refuse("file " + excerpt(name, 80) +
           " must be in the folder of the written scene or below it: set --output");
  return *options_.folder + name;
}

SceneJson SceneWriter::point(const Vec3d& p) const {
  for (const double x : {p.x, p.y, p.z})
    if (!(std::abs(x) <= kMaxCoordinate))
      refuse("coordinates in the scene must be from -1e12 to 1e12 (got " + number_text(x) + ")");
  return {p.x, p.y, p.z};
}

SceneJson SceneWriter::color(const Vec3d& c, double most) {
  Vec3d clamped;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(c[i])) refuse("colour must be finite (got " + number_text(c[i]) + ")");
    clamped[i] = std::clamp(c[i], 0.0, most);
  }
  if (!(clamped == c)) notes_.add("colour outside of 0 to " + number_text(most) + " is clamped");
  return {clamped.x, clamped.y, clamped.z};
}

ImportedScene SceneWriter::finish() {
  if (!root_.objects.empty()) scene_["objects"] = std::move(root_.objects);
  if (!scene_.contains("objects") && !scene_.contains("instances"))
    refuse("scene must have an object that can be drawn (got none)");
  return {std::move(scene_), notes_.texts(), std::move(files_)};
}

}  // namespace orrery
