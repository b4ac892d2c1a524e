#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/meshes/mesh_file.h"

// Content of a model file: the mesh, and the materials and images that its parts refer to.
namespace orrery {

// Image of a model: the bytes of its file. Not decoded, and possibly invalid.
struct ModelImage {
  std::string name;  // name in the file, for messages
  std::shared_ptr<const std::string> bytes;
};

// Use of an image by a material. The image is looked up at (u, v), where (0, 0) is the lower left, after the
// coordinates are multiplied by `repeat`, turned anticlockwise by `turn_degrees`, and increased by `shift`.
struct ModelTexture {
  enum class Wrap { repeat, mirror, clamp };

  int image = 0;  // index into MeshModel::images
  Wrap wrap = Wrap::repeat, wrap_v = Wrap::repeat;
  std::array<double, 2> repeat{1, 1}, shift{0, 0};
  double turn_degrees = 0;

  bool operator==(const ModelTexture&) const = default;
};

// Value of a material: `factor`, multiplied by the texture if there is one.
template <class V>
struct ModelValue {
  V factor;
  std::optional<ModelTexture> texture = std::nullopt;
};

// Material of a model, in the terms of glTF 2.0 (Khronos, section 3.9). Colours are linear. Textures of
// `base_color` and `emission` have sRGB codes, others are linear.
struct ModelMaterial {
  enum class Alpha { opaque, mask, blend };
  // Channel of the texture that stores a number.
  enum class Channel { red, green, blue, luminance };

  std::string name;
  ModelValue<Vec3d> base_color{Vec3d(1)};
  ModelValue<double> metallic{0}, roughness{1};
  // Reflectance of the dielectric. The texture has sRGB codes, unless its alpha is meant.
  ModelValue<Vec3d> normal_reflectance{Vec3d(0.04)};
  bool reflectance_in_alpha = false;
  Channel metallic_channel = Channel::blue, roughness_channel = Channel::green;
  ModelValue<Vec3d> emission{Vec3d(0)};
  // Clear coat over the material: fraction of the surface, in the red channel of the texture.
  ModelValue<double> coat{0};
  double coat_roughness = 0;
  // Reflectance of fibres between the coat and the rest. The texture has sRGB codes.
  ModelValue<Vec3d> sheen{Vec3d(0)};
  double sheen_roughness = 0;
  // `factor` multiplies the tangential part of the normal.
  std::optional<ModelValue<double>> normal;
  Alpha alpha = Alpha::opaque;
  double opacity = 1;   // factor of the alpha of the texture of `base_color`
  double cutoff = 0.5;  // Alpha::mask: surfaces with a lower alpha are not there
  bool unlit = false;
  // Share of the light that passes the surface instead of the base. Light is refracted by `ior` and filtered
  // by `filter`, per metre, if the surface encloses a volume. Otherwise it passes straight on, multiplied by
  // the base colour.
  double transmission = 0;
  bool has_volume = false;
  double ior = 1.5;
  Vec3d filter{1};
};

// Camera of a model, in the axes of the file.
struct ModelCamera {
  std::string name;
  Vec3d eye, direction, up;  // directions are unit
  double fov_degrees = 0;    // vertical field of view; 0: orthographic
  double height = 0;         // height of an orthographic view
};

// Light of a model, in the axes of the file: see KHR_lights_punctual (Khronos).
struct ModelLight {
  enum class Kind { directional, point, spot } kind;
  Vec3d position, direction;                     // direction in which the light shines, unit
  Vec3d intensity;                               // candela; of a directional light: lux
  double inner_degrees = 0, outer_degrees = 45;  // half angles of a spot
};

// Time of an animation of a model.
struct ModelPose {
  int animation = 0;  // number in the file. REQUIRES: at least 0
  double time = 0;    // in seconds from the start of the animation

  auto operator<=>(const ModelPose&) const = default;
};

// State in which a model is read. Default: at rest, with the materials that the file states first.
struct ModelState {
  std::optional<ModelPose> pose = {};
  std::string variant = {};  // name of a variant of the materials (KHR_materials_variants, Khronos)

  auto operator<=>(const ModelState&) const = default;
};

struct ModelAnimation {
  std::string name;
  double seconds;  // duration; 0 if the file does not state it
};

struct MeshModel {
  TriangleMesh mesh;
  std::vector<ModelMaterial> materials;
  std::vector<ModelImage> images;
  std::vector<ModelCamera> cameras = {};
  std::vector<ModelLight> lights = {};
  std::vector<ModelAnimation> animations = {};
  std::vector<std::string> variants = {};  // names of the variants of the materials
  std::string unit = {};  // name of the unit of lengths in the file, or empty if the format has none
  MeshFormat format = MeshFormat::obj;  // format of the file, or of the model in an archive
};
using MeshModelPtr = std::shared_ptr<const MeshModel>;

// Reads a model file: see read_mesh() for the formats and the mesh. Parts of the mesh refer to `materials`.
// Reads a ZIP archive as the model in it (core/meshes/model_archive.h), with files from the archive only.
// `state` applies to glTF models. Other models with a state are rejected.
MeshModel read_model(std::string_view bytes, const MeshLimits& limits = {}, const ReadNearby& nearby = {},
                     const ModelState& state = {});

// Returns a model of a mesh without materials.
inline MeshModelPtr model_of(TriangleMesh mesh) {
  return std::make_shared<const MeshModel>(MeshModel{std::move(mesh), {}, {}});
}

// Returns the model if it has no images. Otherwise returns a model of its mesh alone.
inline MeshModelPtr without_images(MeshModelPtr model) {
  return model->images.empty() ? model : model_of(model->mesh);
}

// Returns the only part of a mesh without parts.
MeshPart only_part(const TriangleMesh& mesh);

// Returns the numbers of the materials of the parts in ascending order, without repetitions. The number -1
// stands for parts without a material.
std::vector<int> materials_in_use(const TriangleMesh& mesh);

// Returns the triangles with a material number, and the vertices that they use. Keeps normals, uvs and
// colours if every such part has them.
TriangleMesh part_of(const TriangleMesh& mesh, int material);

// Returns the mesh as one part. Keeps normals, uvs and colours if every part has them.
TriangleMesh whole_of(TriangleMesh mesh);

}  // namespace orrery
