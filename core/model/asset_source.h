#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"
#include "core/pictures/picture.h"

namespace orrery {

// Where a scene gets meshes and pictures that are not written in it. This one has none; whoever loads scenes
// may know some. Each throws InputError (pointer "") if there is no such thing, or what is there is none.
class AssetSource {
 public:
  virtual ~AssetSource() = default;

  // Of a file beside the scene.
  virtual TriangleMesh mesh_file(const std::string& /*name*/) const { refuse_files(); }
  virtual TexelsPtr picture_file(const std::string& /*name*/) const { refuse_files(); }
  // By the SHA-256 of its bytes, in hexadecimal.
  virtual TriangleMesh mesh_asset(const std::string& /*sha256*/) const { refuse_assets(); }
  virtual TexelsPtr picture_asset(const std::string& /*sha256*/) const { refuse_assets(); }

 private:
  [[noreturn]] static void refuse_files() {
    throw InputError("", "files are read on the command line only: upload it and name it by 'asset'");
  }
  [[noreturn]] static void refuse_assets() {
    throw InputError("", "assets are kept by the service only: name a file beside the scene by 'file'");
  }
};

// Where the meshes of a scene come from, and how much was read of them so far: all have limits together.
struct MeshSource {
  const AssetSource& assets;
  std::size_t vertices = 0, triangles = 0;  // those of keys too
  bool full = false;
  std::uint64_t pairs = 0;  // of triangles around a vertex that smoothing compares
};

}  // namespace orrery
