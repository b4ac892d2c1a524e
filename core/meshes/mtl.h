#pragma once

#include "core/meshes/model.h"

namespace orrery {

// Materials that an OBJ file uses.
struct MtlMaterials {
  std::vector<ModelMaterial> materials;
  std::vector<ModelImage> images;
  std::vector<std::int32_t>
      indices;                     // by used name: index into `materials`, or -1 if there is no such material
  std::vector<std::string> notes;  // see TriangleMesh::notes
};

// Reads the material libraries (MTL) of an OBJ file. `libraries`: texts of its lines "mtllib", each a file
// name, or several without blanks. `used`: distinct names of materials. Reads the first material of a name.
// Files that cannot be read, invalid values and unknown keys give notes. Throws Cancelled.
MtlMaterials read_mtl(const std::vector<std::string>& libraries, const std::vector<std::string>& used,
                      const ReadNearby& nearby);

}  // namespace orrery
