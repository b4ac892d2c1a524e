#pragma once

#include <string>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

// Where a scene gets meshes that are not written in it. This one has none; whoever loads scenes may know
// some. Each throws InputError (pointer "") if there is no such mesh, or what is there is none.
class MeshSource {
 public:
  virtual ~MeshSource() = default;

  // Of a file beside the scene.
  virtual TriangleMesh file(const std::string& /*name*/) const {
    throw InputError("", "files are read on the command line only: upload the mesh and name it by 'asset'");
  }
  // By the SHA-256 of its bytes, in hexadecimal.
  virtual TriangleMesh asset(const std::string& /*sha256*/) const {
    throw InputError("", "assets are kept by the service only: name a file beside the scene by 'file'");
  }
};

}  // namespace orrery
