#include "core/meshes/repair.h"

#include "core/base/task_scope.h"
#include "core/math/face_normal.h"

namespace orrery {

std::size_t drop_degenerate(TriangleMesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const auto& t) {
    checkpoint();
    const Vec3d &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    return face_normal(a, b, c) == Vec3d();
  });
}

void drop_unused(TriangleMesh& mesh) {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> place(mesh.positions.size(), kUnused);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) place[vertex] = 0;
  std::uint32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    checkpoint(v);
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
