#pragma once

#include "core/meshes/index_table.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

struct Vertex {
  Vec3d position, normal;
  std::array<double, 2> uv{};

  bool operator==(const Vertex&) const = default;  // -0 equals 0
};

// Vertex i of a mesh; what the mesh lacks is 0.
inline Vertex vertex_of(const TriangleMesh& mesh, std::size_t i) {
  Vertex vertex;
  vertex.position = mesh.positions[i];
  if (!mesh.normals.empty()) vertex.normal = mesh.normals[i];
  if (!mesh.uvs.empty()) vertex.uv = mesh.uvs[i];
  return vertex;
}

// Vertices without repetition, in the order in which they first came.
class VertexList {
 public:
  VertexList(bool with_normals, bool with_uvs) : with_normals_(with_normals), with_uvs_(with_uvs) {}

  // The number of `vertex` in the list. REQUIRES: it is finite and has 0 for what the list is without; fewer
  // than 2^31 came before.
  std::uint32_t add(const Vertex& vertex);
  std::size_t size() const { return mesh_.positions.size(); }
  // The vertices, and no triangles. The list is empty after it.
  TriangleMesh take() { return std::move(mesh_); }

 private:
  bool with_normals_, with_uvs_;
  TriangleMesh mesh_;
  IndexTable table_;
};

}  // namespace orrery
