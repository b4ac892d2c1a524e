#pragma once

#include "core/model/asset_source.h"
#include "core/shapes/moving_mesh.h"

namespace orrery {

class Params;

// What a scene says about one mesh.
struct MeshObject {
  TriangleMesh mesh;  // empty if there was a problem, which is noted
  std::optional<double> crease_degrees;
  Keys<VertexKey> keys;  // none if it rests
};

// Reads the meshes of a scene, which have limits together: many objects and keys may name one file.
class MeshReader {
 public:
  explicit MeshReader(MeshSource& source) : source_(source) {}
  MeshObject read(Params& p);

 private:
  VertexKey read_key(Params& p, const TriangleMesh& rest, const VertexKey& at_rest);
  // Notes so many more; false, and a problem, if there are too many now.
  bool fits(std::size_t vertices, std::size_t triangles, Params& p);

  MeshSource& source_;
};

}  // namespace orrery
