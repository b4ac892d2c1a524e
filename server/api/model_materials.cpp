#include "server/api/model_materials.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/model/model_images.h"
#include "core/plan/limits.h"

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
      : scene_(scene),
        model_(model),
        materials_(model.materials),
        reference_(reference),
        crease_degrees_(crease_degrees) {
    scene_["materials"] = Json::object();
    for (const MeshPart& part : model.mesh.parts) {
      MeshPart& all = parts_.emplace(part.material, part).first->second;
      all.has_normals = all.has_normals && part.has_normals;
      all.has_uvs = all.has_uvs && part.has_uvs;
      all.has_colors = all.has_colors && part.has_colors;
    }
    if (parts_.empty()) parts_.emplace(-1, only_part(model.mesh));
    for (ModelMaterial& material : materials_) {
      drop_unknown_image(material.base_color.texture);
      drop_unknown_image(material.metallic.texture);
      drop_unknown_image(material.roughness.texture);
      drop_unknown_image(material.emission.texture);
      drop_unknown_image(material.normal_reflectance.texture);
      drop_unknown_image(material.coat.texture);
      drop_unknown_image(material.sheen.texture);
      if (material.normal) drop_unknown_image(material.normal->texture);
    }
  }

  void write(const Json& plain) {
    const std::vector<int> materials = materials_in_use(model_.mesh);
    scene_["objects"] = Json::array();
    for (const int material : materials) {
      checkpoint();
      Json object{{"type", "mesh"}, {reference_.key, reference_.name}};
      if (materials.size() > 1 || material >= 0) object["part"] = material;
      object["material"] = material < 0 ? add_plain_material(plain) : add_material(material);
      if (!has(material, &MeshPart::has_normals)) object["crease_degrees"] = crease_degrees_;
      scene_["objects"].push_back(std::move(object));
    }
  }

 private:
  void drop_unknown_image(std::optional<ModelTexture>& texture) const {
    if (texture && !is_shown(model_.images[static_cast<std::size_t>(texture->image)])) texture.reset();
  }

  // Returns whether all triangles with a material have an attribute.
  bool has(int material, bool MeshPart::*attribute) const { return parts_.at(material).*attribute; }

  // Adds the material of triangles without a material. Vertex colours replace its reflectance.
  std::string add_plain_material(Json plain) {
    if (has(-1, &MeshPart::has_colors)) plain["reflectance"] = {{"texture", vertex_colors()}};
    return add_material("model", std::move(plain));
  }

  // Adds a material under a name that no other material has. Returns the name.
  std::string add_material(const std::string& wanted, Json json) {
    constexpr std::size_t kMaxLength = 100;
    const std::string start = wanted.empty() ? "material" : shortened(wanted, kMaxLength);
    std::string name = start;
    for (int& k = used_[start]; !names_.insert(name).second;) name = start + " " + std::to_string(++k + 1);
    // The name is new. operator[] would search all names for it.
    Json::object_t::Container& members = scene_["materials"].get_ref<Json::object_t&>();
    members.emplace_back(name, std::move(json));
    return name;
  }

  std::string add_material(int index) {
    const ModelMaterial& from = materials_[static_cast<std::size_t>(index)];
    const bool colored = has(index, &MeshPart::has_colors);
    Json json{{"type", "metallic-roughness"}};
    if (from.transmission > 0 && !from.unlit) {
      json = transmitting(from);
    } else if (from.unlit) {  // shows its colour in any light
      json = {{"type", "lambert"}, {"reflectance", 0}, {"emission", color_of(from.base_color, colored)}};
    } else {
      json["base_color"] = color_of(from.base_color, colored);
      json["metallic"] = number_of(from.metallic, from.metallic_channel);
      json["roughness"] = number_of(from.roughness, from.roughness_channel);
      if (from.normal_reflectance.texture || !(from.normal_reflectance.factor == Vec3d(0.04)))
        json["normal_reflectance"] =
            color_of(from.normal_reflectance, false, from.reflectance_in_alpha ? "alpha" : "srgb");
      add_layers(from, json);
      if (!(from.emission.factor == Vec3d(0))) json["emission"] = color_of(from.emission, false);
      if (from.normal && from.normal->texture) {
        json["normal_map"] = {{"texture", texture_name(*from.normal->texture, "linear", false)}};
        if (from.normal->factor != 1) json["normal_map"]["scale"] = from.normal->factor;
      }
    }
    add_opacity(from, json);
    return add_material(from.name, std::move(json));
  }

  // Returns glass for a surface that encloses a volume and transmits at least half of the light. A thin
  // surface is a pane without refraction. The index of refraction of glass has limits.
  static Json transmitting(const ModelMaterial& from) {
    if (from.has_volume && from.transmission >= 0.5)
      return {{"type", "glass"},
              {"ior", std::clamp(from.ior, 1.0, 10.0)},
              {"roughness", from.roughness.factor},
              {"filter", numbers(from.filter)}};
    return {{"type", "transparent"},
            {"blend", "filtered"},
            {"kt", from.transmission},
            {"transmission_color", numbers(from.base_color.factor)},
            {"kd", 1 - from.transmission},
            {"diffuse_color", numbers(from.base_color.factor)},
            {"ka", 0}};
  }

  void add_layers(const ModelMaterial& from, Json& json) {
    const bool has_sheen = !(from.sheen.factor == Vec3d(0));
    if (!(from.coat.factor > 0) && !has_sheen) return;
    json["type"] = "coated";
    if (from.coat.factor > 0) {
      json["coat"] = number_of(from.coat, Channel::red);
      json["coat_roughness"] = from.coat_roughness;
    }
    if (!has_sheen) return;
    json["sheen_color"] = color_of(from.sheen, false);
    json["sheen_roughness"] = from.sheen_roughness;
  }

  void add_opacity(const ModelMaterial& from, Json& json) {
    if (from.alpha == ModelMaterial::Alpha::opaque) return;
    if (from.alpha == ModelMaterial::Alpha::mask) json["alpha_cutoff"] = from.cutoff;
    json["opacity"] = from.opacity;
    if (!from.base_color.texture || from.opacity == 0) return;
    json["opacity"] = {{"texture", texture_name(*from.base_color.texture, "alpha", false)}};
    if (from.opacity != 1) json["opacity"]["scale"] = from.opacity;
  }

  // `colored`: vertex colours multiply the value.
  Json color_of(const ModelValue<Vec3d>& value, bool colored, const char* encoding = "srgb") {
    if (!value.texture && !colored) return numbers(value.factor);
    Json json{{"texture", value.texture ? texture_name(*value.texture, encoding, colored) : vertex_colors()}};
    if (!(value.factor == Vec3d(1))) json["tint"] = numbers(value.factor);
    return json;
  }
  Json number_of(const ModelValue<double>& value, Channel channel) {
    if (!value.texture || value.factor == 0) return value.factor;
    Json json{{"texture", texture_name(*value.texture, "linear", false)}, {"channel", name_of(channel)}};
    if (value.factor != 1) json["scale"] = value.factor;
    return json;
  }

  // Returns the name of a texture, which it adds if the scene lacks it.
  std::string texture_name(const ModelTexture& texture, const char* encoding, bool colored) {
    Json json{{"type", "image"},
              {reference_.key, reference_.name},
              {"image", texture.image},
              {"encoding", encoding},
              {"wrap", name_of(texture.wrap)}};
    if (texture.wrap_v != texture.wrap) json["wrap_v"] = name_of(texture.wrap_v);
    if (colored) json["vertex_colors"] = true;
    if (texture.repeat != std::array{1.0, 1.0} || texture.shift != std::array{0.0, 0.0} ||
        texture.turn_degrees != 0)
      json["mapping"] = {{"type", "uv"},
                         {"repeat_u", texture.repeat[0]},
                         {"repeat_v", texture.repeat[1]},
                         {"turn_degrees", texture.turn_degrees},
                         {"shift_u", texture.shift[0]},
                         {"shift_v", texture.shift[1]}};
    Json& textures = scene_["textures"];
    const std::string start = "image " + std::to_string(texture.image);
    std::string name = start;
    for (int k = 2; textures.contains(name) && textures[name] != json; ++k)
      name = start + " " + std::to_string(k);
    textures[name] = std::move(json);
    require_few(textures);
    return name;
  }
  std::string vertex_colors() {
    scene_["textures"]["vertex colours"] = {{"type", "uniform"}, {"vertex_colors", true}};
    require_few(scene_["textures"]);
    return "vertex colours";
  }

  static void require_few(const Json& textures) {
    if (textures.size() > kMaxTextures)
      throw InputError("", "materials of the model must use at most " + std::to_string(kMaxTextures) +
                               " textures: images in different encodings and placements (limit textures)");
  }

  Json& scene_;
  const MeshModel& model_;
  std::vector<ModelMaterial> materials_;  // with images of known formats only
  const ModelReference& reference_;
  const double crease_degrees_;
  std::map<int, MeshPart> parts_;          // attributes that all triangles with a material have
  std::set<std::string> names_{"ground"};  // names of materials, and of the plane below the model
  std::map<std::string, int> used_;        // number of names that were tried, by their start
};

}  // namespace

void add_model(Json& scene, const MeshModel& model, const ModelReference& reference, const Json& plain,
               double crease_degrees) {
  ModelWriter(scene, model, reference, crease_degrees).write(plain);
}

}  // namespace orrery
