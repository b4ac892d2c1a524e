#pragma once

#include <optional>

#include "core/math/keys.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

// Where the vertices of a mesh are, and what they are shaded with.
struct VertexKey {
  std::vector<Vec3d> positions, normals;  // as many of each; or no normals
};

// Each vertex on a straight line; normals of length 1 again.
VertexKey mix(const VertexKey& before, const VertexKey& after, double share);

// A mesh whose vertices move. Triangles that have no area for a while stay.
struct MovingMesh {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Keys<VertexKey> keys;
  std::optional<double> crease;  // degrees; the normals are those of smooth_normals() then

  // The mesh as it stands at `time`, in seconds. Its triangles keep their order.
  TriangleMesh at(double time) const;
};

}  // namespace orrery
