#include "core/meshes/repair.h"

#include "core/meshes/vertex_list.h"

namespace orrery {

std::size_t drop_degenerate(TriangleMesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const auto& t) {
    const Vec3d &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    return safe_normalize(cross(b - a, c - a)) == Vec3d();
  });
}

std::size_t weld(TriangleMesh& mesh) {
  TriangleMesh old = std::move(mesh);
  VertexList vertices(!old.normals.empty(), !old.uvs.empty());
  std::vector<std::uint32_t> renumbered;
  renumbered.reserve(old.positions.size());
  for (std::size_t i = 0; i < old.positions.size(); ++i)
    renumbered.push_back(vertices.add(vertex_of(old, i)));
  mesh = vertices.take();
  mesh.triangles = std::move(old.triangles);
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& corner : triangle) corner = renumbered[corner];
  return old.positions.size() - mesh.positions.size();
}

void drop_unused(TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> place(mesh.positions.size(), kUnused);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) place[vertex] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == kUnused) continue;
    place[v] = kept;
    mesh.positions[kept] = mesh.positions[v];
    if (!mesh.normals.empty()) mesh.normals[kept] = mesh.normals[v];
    if (!mesh.uvs.empty()) mesh.uvs[kept] = mesh.uvs[v];
    ++kept;
  }
  mesh.positions.resize(kept);
  if (!mesh.normals.empty()) mesh.normals.resize(kept);
  if (!mesh.uvs.empty()) mesh.uvs.resize(kept);
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = place[vertex];
}

}  // namespace orrery
