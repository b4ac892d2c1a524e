#include "core/meshes/inspection.h"

#include "core/base/task_scope.h"
#include "core/meshes/repair.h"

namespace orrery {

MeshInspection inspect_mesh(const TriangleMesh& mesh) {
  MeshInspection found;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) found.bounds.include(mesh.positions[corner]);
  const Vec3d centre = found.bounds.lo + (found.bounds.hi - found.bounds.lo) * 0.5;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    checkpoint(i);
    const auto& [a, b, c] = mesh.triangles[i];
    const Vec3d p = mesh.positions[a] - centre, q = mesh.positions[b] - centre,
                r = mesh.positions[c] - centre;
    const Vec3d twice = cross(q - p, r - p);
    if (twice == Vec3d()) ++found.triangles_without_area;
    found.area += length(twice) / 2;
    found.volume += dot(p, cross(q, r)) / 6;
  }
  found.watertight = is_watertight(mesh.triangles, position_indices_of(mesh.positions));
  if (!found.watertight) found.volume = 0;
  return found;
}

}  // namespace orrery
