#pragma once

#include "core/model/asset_source.h"
#include "core/shapes/moving_mesh.h"

namespace orrery {

class Params;

// Mesh object of a scene.
struct MeshObject {
  TriangleMesh mesh;                     // may be empty if Params recorded a problem
  std::optional<double> crease_degrees;  // nullopt: the normals of the mesh are not smoothed
  Keyframes<VertexKey> keys;             // empty if static
};

// Reads the meshes of one scene. MeshLimits apply to the total over all objects and keyframes, because
// several objects may name the same file. Records problems in Params. Throws Cancelled. Not thread-safe.
class MeshReader {
 public:
  explicit MeshReader(MeshSource& source) : source_(source) {}
  MeshObject read(Params& p);

 private:
  VertexKey read_key(Params& p, const TriangleMesh& rest, const VertexKey& at_rest);
  // Adds the counts to the totals of the scene. Returns false if a total exceeds its limit, and records a
  // problem the first time.
  bool fits(std::size_t vertices, std::size_t triangles, Params& p);

  MeshSource& source_;
};

}  // namespace orrery
