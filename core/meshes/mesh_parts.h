#pragma once

#include "core/base/task_scope.h"
#include "core/meshes/mesh_file.h"

namespace orrery {

// Starts a part at triangle `first` if `material` differs from that of the last part.
void start_part(std::size_t first, std::int32_t material, std::vector<MeshPart>& parts);

// Sorts the triangles so that each material has one part. Materials keep the order of their first triangles,
// and the triangles of a material keep their order. Drops empty parts. Throws Cancelled. REQUIRES: parts
// without attributes in ascending order, the first at triangle 0; materials >= -1.
void group_parts(TriangleMesh& mesh);

// Sets `has` of each part whose vertices all satisfy holds(vertex). Throws Cancelled.
template <class Holds>
void set_attribute(bool MeshPart::*has, const Holds& holds, TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const std::size_t end =
        i + 1 < mesh.parts.size() ? mesh.parts[i + 1].first_triangle : mesh.triangles.size();
    bool all = true;
    for (std::size_t t = mesh.parts[i].first_triangle; all && t < end; ++t) {
      checkpoint(t);
      for (const std::uint32_t vertex : mesh.triangles[t]) all = all && holds(vertex);
    }
    mesh.parts[i].*has = all;
  }
}

}  // namespace orrery
