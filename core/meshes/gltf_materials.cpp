#include "core/meshes/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/note_list.h"
#include "core/meshes/text.h"

// glTF 2.0 (Khronos, ISO/IEC 12113:2022): section 3.8 (texture data) and section 3.9 (materials). Extensions:
// KHR_texture_transform, KHR_materials_emissive_strength, KHR_materials_unlit, KHR_materials_ior,
// KHR_materials_specular, KHR_materials_clearcoat and KHR_materials_sheen with the textures of colours and of
// the clear coat, KHR_materials_transmission and KHR_materials_volume without their textures.
namespace orrery {
namespace {

constexpr std::string_view kExtensions[] = {
    "KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_unlit",
    "KHR_materials_ior",     "KHR_materials_specular",          "KHR_materials_transmission",
    "KHR_materials_volume",  "KHR_materials_clearcoat",         "KHR_materials_sheen"};
constexpr std::size_t kMaxNotes = 20;  // notes about images
// Buffer views of images may overlap, and each image is a copy.
constexpr std::size_t kMaxImageBytes = std::size_t{1} << 30;
constexpr double kMaxEmission = 1e6;  // factor of emission; larger ones are reduced

double number_or(const GltfValue& object, const char* key, double fallback, double least, double most) {
  const auto value = object.find(key);
  if (!value) return fallback;
  const double number = value->number();
  if (!(number >= least && number <= most))
    value->fail("must be from " + text_of(least) + " to " + text_of(most) + " (got " + text_of(number) + ")");
  return number;
}

// Reads the first three numbers of a list, each from 0 to `most`.
Vec3d color_or(const GltfValue& object, const char* key, const Vec3d& fallback, double most = 1) {
  const auto list = object.find(key);
  if (!list) return fallback;
  const auto channel = [&](std::size_t i) {
    const double number = list->item(i).number();
    if (!(number >= 0 && number <= most))
      list->item(i).fail("must be from 0 to " + text_of(most) + " (got " + text_of(number) + ")");
    return number;
  };
  return {channel(0), channel(1), channel(2)};
}

class MaterialReader {
 public:
  explicit MaterialReader(GltfFile& file) : file_(file) {}

  GltfMaterials read() {
    const auto materials = file_.root().find("materials");
    for (std::size_t i = 0; materials && i < materials->size(); ++i) {
      checkpoint();
      uv_set_.reset();
      read_material(materials->item(i));
      found_.uv_sets.push_back(uv_set_.value_or(0));
    }
    missing_images_.move_to(found_.notes);
    for (const auto& [extension, count] : ignored_textures_)
      found_.notes.push_back(grouped(count) + " textures of " + std::string(extension) + " are not modelled");
    if (reduced_emissions_ > 0)
      found_.notes.push_back(grouped(reduced_emissions_) + " materials emit more than " +
                             text_of(kMaxEmission) + ", which is the limit");
    if (coats_with_normals_ > 0)
      found_.notes.push_back(grouped(coats_with_normals_) +
                             " materials have a clear coat with other normals, which are not modelled");
    if (mixed_sets_ > 0)
      found_.notes.push_back(grouped(mixed_sets_) +
                             " materials use two sets of texture coordinates, of which one is modelled");
    return std::move(found_);
  }

 private:
  void read_material(const GltfValue& json) {
    ModelMaterial& material = found_.materials.emplace_back();
    if (const auto name = json.find("name")) material.name = name->text();
    material.metallic.factor = 1;
    if (const auto pbr = json.find("pbrMetallicRoughness")) read_pbr(*pbr, material);
    material.emission.factor = color_or(json, "emissiveFactor", Vec3d(0));
    if (const auto strength = extension_of(json, "KHR_materials_emissive_strength"))
      scale_emission(number_or(*strength, "emissiveStrength", 1, 0, std::numeric_limits<double>::max()),
                     material);
    if (!(material.emission.factor == Vec3d(0)))
      material.emission.texture = read_texture(json, "emissiveTexture");
    if (const auto texture = read_texture(json, "normalTexture"))
      material.normal = {number_or(json.at("normalTexture"), "scale", 1, -kMaxScale, kMaxScale), texture};
    if (const auto mode = json.find("alphaMode")) material.alpha = alpha_of(*mode);
    material.cutoff = number_or(json, "alphaCutoff", 0.5, 0, std::numeric_limits<double>::max());
    material.ior = read_ior(json);
    read_normal_reflectance(json, material);
    read_transmission(json, material);
    read_coat(json, material);
    read_sheen(json, material);
    material.unlit = extension_of(json, "KHR_materials_unlit").has_value();
  }

  void scale_emission(double strength, ModelMaterial& material) {
    const double largest = max_component(material.emission.factor),
                 most = kMaxEmission / std::max(largest, 1e-300);
    if (strength > most) ++reduced_emissions_;
    material.emission.factor = material.emission.factor * std::min(strength, most);
  }

  // The filter per metre is the attenuation colour to the power of 1 / attenuation distance.
  void read_transmission(const GltfValue& json, ModelMaterial& material) {
    const auto transmission = extension_of(json, "KHR_materials_transmission");
    if (!transmission) return;
    material.transmission = number_or(*transmission, "transmissionFactor", 0, 0, 1);
    ignore_texture(*transmission, "transmissionTexture", "KHR_materials_transmission");
    const auto volume = extension_of(json, "KHR_materials_volume");
    if (!volume || !(number_or(*volume, "thicknessFactor", 0, 0, kMaxDistance) > 0)) return;
    material.has_volume = true;
    const Vec3d color = color_or(*volume, "attenuationColor", Vec3d(1));
    const auto distance = volume->find("attenuationDistance");
    if (!distance) return;
    const double metres = number_or(*volume, "attenuationDistance", 0, 0, kMaxDistance);
    if (!(metres > 0)) distance->fail("must be greater than 0 (got 0)");
    material.filter = {std::pow(color.x, 1 / metres), std::pow(color.y, 1 / metres),
                       std::pow(color.z, 1 / metres)};
  }

  static double read_ior(const GltfValue& json) {
    const auto ior = extension_of(json, "KHR_materials_ior");
    return ior ? number_or(*ior, "ior", 1.5, 0, kMaxIor) : 1.5;
  }

  // The reflectance of a dielectric with an index n is ((n - 1) / (n + 1))^2. An index of 0 makes it 1. If
  // there are two textures, the one of the colour is modelled.
  void read_normal_reflectance(const GltfValue& json, ModelMaterial& material) {
    Vec3d& reflectance = material.normal_reflectance.factor;
    const double root = (material.ior - 1) / (material.ior + 1);
    reflectance = Vec3d(material.ior == 1.5 ? 0.04 : root * root);
    const auto specular = extension_of(json, "KHR_materials_specular");
    if (!specular) return;
    reflectance = reflectance * color_or(*specular, "specularColorFactor", Vec3d(1), kMaxIor);
    const auto within = [](double x) { return std::min(x, 1.0); };
    reflectance = Vec3d(within(reflectance.x), within(reflectance.y), within(reflectance.z)) *
                  number_or(*specular, "specularFactor", 1, 0, 1);
    material.normal_reflectance.texture = read_texture(*specular, "specularColorTexture");
    if (material.normal_reflectance.texture) {
      ignore_texture(*specular, "specularTexture", "KHR_materials_specular");
    } else {
      material.normal_reflectance.texture = read_texture(*specular, "specularTexture");
      material.reflectance_in_alpha = true;
    }
  }

  void read_coat(const GltfValue& json, ModelMaterial& material) {
    constexpr const char* kName = "KHR_materials_clearcoat";
    const auto coat = extension_of(json, kName);
    if (!coat) return;
    material.coat.factor = number_or(*coat, "clearcoatFactor", 0, 0, 1);
    if (material.coat.factor > 0) material.coat.texture = read_texture(*coat, "clearcoatTexture");
    material.coat_roughness = number_or(*coat, "clearcoatRoughnessFactor", 0, 0, 1);
    ignore_texture(*coat, "clearcoatRoughnessTexture", kName);
    const auto image_of = [](const GltfValue& value, const char* key) {
      const auto use = value.find(key);
      return use ? std::optional(use->at("index").integer()) : std::nullopt;
    };
    if (image_of(json, "normalTexture") != image_of(*coat, "clearcoatNormalTexture")) ++coats_with_normals_;
  }

  void read_sheen(const GltfValue& json, ModelMaterial& material) {
    constexpr const char* kName = "KHR_materials_sheen";
    const auto sheen = extension_of(json, kName);
    if (!sheen) return;
    material.sheen.factor = color_or(*sheen, "sheenColorFactor", Vec3d(0));
    if (!(material.sheen.factor == Vec3d(0)))
      material.sheen.texture = read_texture(*sheen, "sheenColorTexture");
    material.sheen_roughness = number_or(*sheen, "sheenRoughnessFactor", 0, 0, 1);
    ignore_texture(*sheen, "sheenRoughnessTexture", kName);
  }

  // Counts a texture that is not modelled, for the notes.
  void ignore_texture(const GltfValue& extension, const char* key, std::string_view name) {
    if (extension.find(key)) ++ignored_textures_[name];
  }

  void read_pbr(const GltfValue& pbr, ModelMaterial& material) {
    material.base_color.factor = color_or(pbr, "baseColorFactor", Vec3d(1));
    if (const auto factor = pbr.find("baseColorFactor"); factor && factor->size() > 3) {
      const double opacity = factor->item(3).number();
      if (!(opacity >= 0 && opacity <= 1))
        factor->item(3).fail("must be from 0 to 1 (got " + text_of(opacity) + ")");
      material.opacity = opacity;
    }
    material.base_color.texture = read_texture(pbr, "baseColorTexture");
    material.metallic.factor = number_or(pbr, "metallicFactor", 1, 0, 1);
    material.roughness.factor = number_or(pbr, "roughnessFactor", 1, 0, 1);
    material.metallic.texture = material.roughness.texture = read_texture(pbr, "metallicRoughnessTexture");
  }

  static ModelMaterial::Alpha alpha_of(const GltfValue& mode) {
    if (mode.text() == "OPAQUE") return ModelMaterial::Alpha::opaque;
    if (mode.text() == "MASK") return ModelMaterial::Alpha::mask;
    if (mode.text() == "BLEND") return ModelMaterial::Alpha::blend;
    mode.fail("must be OPAQUE, MASK or BLEND (got " + excerpt(mode.text()) + ")");
  }

  // Reads a texture of a material. Returns nullopt if there is none or its image is missing.
  std::optional<ModelTexture> read_texture(const GltfValue& material, const char* key) {
    const auto use = material.find(key);
    if (!use) return std::nullopt;
    const GltfValue texture = file_.root().at("textures").item(use->at("index").integer());
    ModelTexture found;
    const auto webp = extension_of(texture, "EXT_texture_webp");
    const auto source = webp ? webp->find("source") : texture.find("source");
    const auto image = source ? find_image(*source) : std::nullopt;
    if (!image) return std::nullopt;
    found.image = *image;
    if (const auto sampler = texture.find("sampler")) {
      const GltfValue modes = file_.root().at("samplers").item(sampler->integer());
      found.wrap = read_wrap(modes, "wrapS");
      found.wrap_v = read_wrap(modes, "wrapT");
    }
    std::uint64_t set = integer_or(*use, "texCoord", 0);
    if (const auto transform = extension_of(*use, "KHR_texture_transform")) {
      set = integer_or(*transform, "texCoord", set);
      read_transform(*transform, found);
    }
    if (set > kMaxSet) use->fail("texCoord must be from 0 to 7 (got " + std::to_string(set) + ")");
    if (uv_set_ && *uv_set_ != static_cast<int>(set)) ++mixed_sets_;
    if (!uv_set_) uv_set_ = static_cast<int>(set);
    return found;
  }

  // Returns the index of an image in found_.images.
  std::optional<int> find_image(const GltfValue& source) {
    const std::uint64_t index = source.integer();
    if (const auto known = images_.find(index); known != images_.end()) return known->second;
    const GltfValue image = file_.root().at("images").item(index);
    try {
      std::string name = "image " + std::to_string(index);
      if (const auto uri = image.find("uri"); uri && !uri->text().starts_with("data:"))
        name = shortened(uri->text(), 80);
      return images_[index] = add_image(std::move(name), file_.image_bytes(image));
    } catch (const InputError& error) {
      missing_images_.add("an image is missing: " + error.problems().front().detail);
      return images_[index] = std::nullopt;
    }
  }

  // Returns the index of an image in found_.images. Images with the same bytes of the file are one.
  int add_image(std::string name, std::string_view bytes) {
    const std::pair place(bytes.data(), bytes.size());
    if (const auto known = image_at_.find(place); known != image_at_.end()) return known->second;
    if (bytes.size() > kMaxImageBytes - image_bytes_)
      throw InputError("", "images have more than " + grouped(kMaxImageBytes) + " bytes (limit " +
                               grouped(kMaxImageBytes) + ")");
    image_bytes_ += bytes.size();
    found_.images.push_back({std::move(name), std::make_shared<const std::string>(bytes)});
    return image_at_[place] = static_cast<int>(found_.images.size()) - 1;
  }

  static ModelTexture::Wrap read_wrap(const GltfValue& sampler, const char* key) {
    const std::uint64_t mode = integer_or(sampler, key, kRepeat);
    switch (mode) {
      case kRepeat: return ModelTexture::Wrap::repeat;
      case 33648: return ModelTexture::Wrap::mirror;
      case 33071: return ModelTexture::Wrap::clamp;
      default:
        sampler.fail(std::string(key) + " must be 10497, 33071 or 33648 (got " + std::to_string(mode) + ")");
    }
  }

  // The transform of glTF applies to (u, 1 - v): (u, v) of glTF, multiplied by the scale, turned
  // anticlockwise as seen with v downward, and increased by the offset.
  void read_transform(const GltfValue& transform, ModelTexture& texture) {
    const auto pair = [&](const char* key, double fallback) {
      std::array<double, 2> numbers{fallback, fallback};
      const auto list = transform.find(key);
      for (std::size_t i = 0; list && i < numbers.size(); ++i) {
        numbers[i] = list->item(i).number();
        if (!(std::abs(numbers[i]) <= kMaxScale))
          list->item(i).fail("must be at most " + text_of(kMaxScale) + " in magnitude (got " +
                             text_of(numbers[i]) + ")");
      }
      return numbers;
    };
    const auto [left, top] = pair("offset", 0);
    const auto [across, down] = pair("scale", 1);
    const double angle = number_or(transform, "rotation", 0, -kMaxAngle, kMaxAngle);
    texture.repeat = {across, down};
    texture.turn_degrees = std::remainder(angle / std::numbers::pi * 180, 360.0);
    texture.shift = {left + std::sin(angle) * down, 1 - std::cos(angle) * down - top};
  }

  static constexpr std::uint64_t kRepeat = 10497, kMaxSet = 7;
  static constexpr double kMaxScale = 1e5, kMaxAngle = 1e6, kMaxIor = 1e6, kMaxDistance = 1e12;

  GltfFile& file_;
  GltfMaterials found_;
  std::map<std::uint64_t, std::optional<int>> images_;           // by image of the file
  std::map<std::pair<const char*, std::size_t>, int> image_at_;  // by place in the file
  std::size_t image_bytes_ = 0;
  std::optional<int> uv_set_;  // set of the current material
  NoteList missing_images_{kMaxNotes, " more images are missing"};
  std::map<std::string_view, std::size_t> ignored_textures_;  // by extension
  std::size_t mixed_sets_ = 0, coats_with_normals_ = 0, reduced_emissions_ = 0;
};

}  // namespace

bool is_material_extension(std::string_view name) {
  return std::find(std::begin(kExtensions), std::end(kExtensions), name) != std::end(kExtensions);
}

GltfMaterials read_gltf_materials(GltfFile& file) { return MaterialReader(file).read(); }

}  // namespace orrery
