#pragma once

#include "core/meshes/index_table.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

struct Vertex {
  Vec3d position, normal;
  std::array<double, 2> uv{};
  Vec3d color = {};

  bool operator==(const Vertex&) const = default;  // -0 equals 0
};

// Returns vertex i of a mesh, with 0 for missing attributes.
inline Vertex vertex_of(const TriangleMesh& mesh, std::size_t i) {
  Vertex vertex;
  vertex.position = mesh.positions[i];
  if (!mesh.normals.empty()) vertex.normal = mesh.normals[i];
  if (!mesh.uvs.empty()) vertex.uv = mesh.uvs[i];
  if (!mesh.colors.empty()) vertex.color = mesh.colors[i];
  return vertex;
}

// List of distinct vertices, in order of first occurrence. Not thread-safe. add() throws Cancelled.
class VertexList {
 public:
  VertexList(bool with_normals, bool with_uvs, bool with_colors = false)
      : with_normals_(with_normals), with_uvs_(with_uvs), with_colors_(with_colors) {}

  // Returns the index of `vertex` in the list. Appends the vertex if the list does not contain it. REQUIRES:
  // `vertex` is finite, values that the list does not store are 0, and the list has fewer than 2^31 vertices.
  std::uint32_t add(const Vertex& vertex);
  std::size_t size() const { return mesh_.positions.size(); }
  // Returns the normal of a vertex. REQUIRES: the list stores normals.
  const Vec3d& normal(std::uint32_t vertex) const { return mesh_.normals[vertex]; }
  // Moves the vertices out, as a mesh without triangles. The list must not be used afterwards.
  TriangleMesh take() { return std::move(mesh_); }

 private:
  bool with_normals_, with_uvs_, with_colors_;
  TriangleMesh mesh_;
  IndexTable table_;
};

}  // namespace orrery
