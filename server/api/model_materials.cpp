#include "server/api/model_materials.h"

#include <algorithm>
#include <array>
#include <set>

#include "core/base/shorten.h"

namespace orrery {
namespace {

using Json = nlohmann::ordered_json;
using Channel = ModelMaterial::Channel;

constexpr std::string_view name_of(ModelTexture::Wrap wrap) {
  constexpr std::array<std::string_view, 3> kNames{"repeat", "mirror", "clamp"};
  return kNames[static_cast<std::size_t>(wrap)];
}
constexpr std::string_view name_of(Channel channel) {
  constexpr std::array<std::string_view, 4> kNames{"red", "green", "blue", "luminance"};
  return kNames[static_cast<std::size_t>(channel)];
}

Json numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

class ModelWriter {
 public:
  ModelWriter(Json& scene, const MeshModel& model, const ModelReference& reference, double crease_degrees)
      : scene_(scene), model_(model), reference_(reference), crease_degrees_(crease_degrees) {}

  void write(const Json& plain) {
    const std::vector<int> materials = materials_in_use(model_.mesh);
    scene_["objects"] = Json::array();
    for (const int material : materials) {
      Json object{{"type", "mesh"}, {reference_.key, reference_.name}};
      if (materials.size() > 1 || material >= 0) object["part"] = material;
      object["material"] = material < 0 ? add_material("model", plain) : add_material(material);
      if (!has_normals(material)) object["crease_degrees"] = crease_degrees_;
      scene_["objects"].push_back(std::move(object));
    }
  }

 private:
  bool has_normals(int material) const {
    const TriangleMesh& mesh = model_.mesh;
    if (mesh.parts.empty()) return !mesh.normals.empty();
    return std::all_of(mesh.parts.begin(), mesh.parts.end(),
                       [&](const MeshPart& part) { return part.material != material || part.has_normals; });
  }

  // Adds a material under a name that no other material has. Returns the name.
  std::string add_material(const std::string& wanted, Json json) {
    constexpr std::size_t kMaxLength = 100;
    const std::string start = wanted.empty() ? "material" : shortened(wanted, kMaxLength);
    std::string name = start;
    for (int k = 2; !names_.insert(name).second; ++k) name = start + " " + std::to_string(k);
    scene_["materials"][name] = std::move(json);
    return name;
  }

  std::string add_material(int index) {
    const ModelMaterial& from = model_.materials[static_cast<std::size_t>(index)];
    Json json{{"type", "metallic-roughness"}};
    json["base_color"] = value_of(from.base_color, "srgb");
    json["metallic"] = value_of(from.metallic, from.metallic_channel);
    json["roughness"] = value_of(from.roughness, from.roughness_channel);
    if (!(from.emission.factor == Vec3d(0))) json["emission"] = numbers(from.emission.factor);
    return add_material(from.name, std::move(json));
  }

  Json value_of(const ModelValue<Vec3d>& value, const char* encoding) {
    if (!value.texture) return numbers(value.factor);
    Json json{{"texture", texture_name(*value.texture, encoding)}};
    if (!(value.factor == Vec3d(1))) json["tint"] = numbers(value.factor);
    return json;
  }
  Json value_of(const ModelValue<double>& value, Channel channel) {
    if (!value.texture || value.factor == 0) return value.factor;
    Json json{{"texture", texture_name(*value.texture, "linear")}, {"channel", name_of(channel)}};
    if (value.factor != 1) json["scale"] = value.factor;
    return json;
  }

  // Returns the name of a texture, which it adds if the scene lacks it.
  std::string texture_name(const ModelTexture& texture, const char* encoding) {
    Json json{{"type", "image"},
              {reference_.key, reference_.name},
              {"image", texture.image},
              {"encoding", encoding},
              {"wrap", name_of(texture.wrap)}};
    if (texture.repeat != std::array{1.0, 1.0} || texture.shift != std::array{0.0, 0.0})
      json["mapping"] = {{"type", "uv"},
                         {"repeat_u", texture.repeat[0]},
                         {"repeat_v", texture.repeat[1]},
                         {"shift_u", texture.shift[0]},
                         {"shift_v", texture.shift[1]}};
    Json& textures = scene_["textures"];
    const std::string start = "image " + std::to_string(texture.image);
    std::string name = start;
    for (int k = 2; textures.contains(name) && textures[name] != json; ++k)
      name = start + " " + std::to_string(k);
    textures[name] = std::move(json);
    return name;
  }

  Json& scene_;
  const MeshModel& model_;
  const ModelReference& reference_;
  const double crease_degrees_;
  std::set<std::string> names_{"ground"};  // names of materials, and of the plane below the model
};

}  // namespace

void add_model(Json& scene, const MeshModel& model, const ModelReference& reference, const Json& plain,
               double crease_degrees) {
  ModelWriter(scene, model, reference, crease_degrees).write(plain);
}

}  // namespace orrery
