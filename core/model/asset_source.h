#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"
#include "core/pictures/picture.h"

namespace orrery {

// Source of meshes and pictures that are not written in the scene itself. The base class has none; loaders of
// scenes may override it. Each function throws InputError (pointer "") if the asset is missing or invalid,
// and Cancelled. Only the thread that loads the scene calls it.
class AssetSource {
 public:
  virtual ~AssetSource() = default;

  // Returns the contents of a file next to the scene file.
  virtual TriangleMesh mesh_file(const std::string& /*name*/) const { refuse_files(); }
  virtual TexelsPtr picture_file(const std::string& /*name*/) const { refuse_files(); }
  // Returns an uploaded asset by the SHA-256 of its bytes, in hexadecimal.
  virtual TriangleMesh mesh_asset(const std::string& /*sha256*/) const { refuse_assets(); }
  virtual TexelsPtr picture_asset(const std::string& /*sha256*/) const { refuse_assets(); }

 private:
  [[noreturn]] static void refuse_files() {
    throw InputError("",
                     "files can be read on the command line only; upload the file and name it in \"asset\"");
  }
  [[noreturn]] static void refuse_assets() {
    throw InputError("", "assets exist in the service only; name a file next to the scene in \"file\"");
  }
};

// Source of a scene's meshes, with running totals: the limits apply to all meshes of a scene together.
struct MeshSource {
  const AssetSource& assets;
  std::size_t vertices = 0, triangles = 0;  // including those of animation keys
  bool full = false;
  std::uint64_t pairs = 0;  // triangle pairs around a vertex that smoothing compares
};

}  // namespace orrery
