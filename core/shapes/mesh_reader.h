#pragma once

#include "core/model/asset_source.h"
#include "core/shapes/moving_mesh.h"

namespace orrery {

class Params;

// Mesh object of a scene.
struct MeshObject {
  TriangleMesh mesh;  // empty after a problem, which Params records
  std::optional<double> crease_degrees;
  Keyframes<VertexKey> keys;  // empty if static
};

// Reads the meshes of a scene. Limits apply to their sum, because many objects and keys may name one file.
// Records problems in Params. Throws Cancelled. Not thread-safe.
class MeshReader {
 public:
  explicit MeshReader(MeshSource& source) : source_(source) {}
  MeshObject read(Params& p);

 private:
  VertexKey read_key(Params& p, const TriangleMesh& rest, const VertexKey& at_rest);
  // Adds to the running totals. Returns false and records a problem if a limit is exceeded.
  bool fits(std::size_t vertices, std::size_t triangles, Params& p);

  MeshSource& source_;
};

}  // namespace orrery
