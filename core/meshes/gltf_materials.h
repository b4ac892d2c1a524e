#pragma once

#include "core/meshes/gltf_file.h"
#include "core/meshes/model.h"

namespace orrery {

// Materials of a glTF file.
struct GltfMaterials {
  std::vector<ModelMaterial> materials;
  std::vector<int> uv_sets;  // by material: number of the texture coordinates that its textures use
  std::vector<ModelImage> images;
  std::vector<std::string> notes;  // see TriangleMesh::notes
};

// Reads the materials and the images that they use. Images that cannot be read are left out, with a note.
// Throws InputError if a material is invalid, and Cancelled.
GltfMaterials read_gltf_materials(GltfFile& file);

// Returns true if the materials of an extension are read.
bool is_material_extension(std::string_view name);

}  // namespace orrery
