#include "core/shapes/moving_mesh.h"

#include "core/meshes/repair.h"

namespace orrery {

VertexKey mix(const VertexKey& before, const VertexKey& after, double share) {
  VertexKey mixed;
  mixed.positions.reserve(before.positions.size());
  for (std::size_t v = 0; v < before.positions.size(); ++v)
    mixed.positions.push_back(before.positions[v] * (1 - share) + after.positions[v] * share);
  mixed.normals.reserve(before.normals.size());
  for (std::size_t v = 0; v < before.normals.size(); ++v) {
    const Vec3d normal = safe_normalize(before.normals[v] * (1 - share) + after.normals[v] * share);
    mixed.normals.push_back(normal == Vec3d() ? before.normals[v] : normal);
  }
  return mixed;
}

TriangleMesh MovingMesh::at(double time) const {
  VertexKey vertices = keys.at(time);
  TriangleMesh mesh{std::move(vertices.positions), triangles, std::move(vertices.normals), {}};
  if (crease) smooth_normals(mesh, *crease);
  return mesh;
}

}  // namespace orrery
