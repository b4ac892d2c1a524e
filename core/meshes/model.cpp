#include "core/meshes/model.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/meshes/repair.h"

namespace orrery {
namespace {

// Clears the attributes that not every one of the parts has.
template <class Parts>
void drop_partial_attributes(const Parts& parts, TriangleMesh& mesh) {
  const auto all_have = [&](bool MeshPart::*has) {
    return std::all_of(parts.begin(), parts.end(), [&](const MeshPart& part) { return part.*has; });
  };
  if (!all_have(&MeshPart::has_normals)) mesh.normals.clear();
  if (!all_have(&MeshPart::has_uvs)) mesh.uvs.clear();
  if (!all_have(&MeshPart::has_colors)) mesh.colors.clear();
}

// Adds the vertices of `mesh` that the triangles of `part` use to `part`, and renumbers the triangles.
// Vertices of a part are mostly close together in the file, so a table over their range is small.
void take_vertices(const TriangleMesh& mesh, TriangleMesh& part) {
  std::uint32_t first = ~0u, last = 0;
  for (const auto& triangle : part.triangles)
    for (const std::uint32_t vertex : triangle) {
      first = std::min(first, vertex);
      last = std::max(last, vertex);
    }
  const auto copy = [&](const auto& from, auto& to) {
    if (from.empty()) return;
    to.assign(from.begin() + first, from.begin() + last + 1);
    checkpoint();
  };
  copy(mesh.positions, part.positions);
  copy(mesh.normals, part.normals);
  copy(mesh.uvs, part.uvs);
  copy(mesh.colors, part.colors);
  for (auto& triangle : part.triangles)
    for (std::uint32_t& vertex : triangle) vertex -= first;
  drop_unused(part);
}

}  // namespace

MeshPart only_part(const TriangleMesh& mesh) {
  return {0, -1, !mesh.normals.empty(), !mesh.uvs.empty(), !mesh.colors.empty()};
}

std::vector<int> materials_in_use(const TriangleMesh& mesh) {
  if (mesh.parts.empty()) return {-1};
  std::vector<int> materials;
  for (const MeshPart& part : mesh.parts) materials.push_back(part.material);
  std::sort(materials.begin(), materials.end());
  materials.erase(std::unique(materials.begin(), materials.end()), materials.end());
  return materials;
}

TriangleMesh part_of(const TriangleMesh& mesh, int material) {
  TriangleMesh part;
  std::vector<MeshPart> taken;
  const std::vector<MeshPart> only{only_part(mesh)}, &parts = mesh.parts.empty() ? only : mesh.parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    checkpoint(i);
    if (parts[i].material != material) continue;
    taken.push_back(parts[i]);
    const auto at = [&](std::size_t k) {
      return mesh.triangles.begin() +
             static_cast<std::ptrdiff_t>(k < parts.size() ? parts[k].first_triangle : mesh.triangles.size());
    };
    part.triangles.insert(part.triangles.end(), at(i), at(i + 1));
  }
  if (part.triangles.empty()) return part;
  take_vertices(mesh, part);
  drop_partial_attributes(taken, part);
  return part;
}

TriangleMesh whole_of(TriangleMesh mesh) {
  drop_partial_attributes(mesh.parts, mesh);
  mesh.parts.clear();
  return mesh;
}

}  // namespace orrery
