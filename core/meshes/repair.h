#pragma once

#include <cstddef>
#include <cstdint>

#include "core/meshes/mesh_file.h"

// Repairs of meshes before use. Each function keeps the order of the remaining elements. Each may throw
// Cancelled; the mesh is then unusable. REQUIRES: valid indices and finite coordinates, as returned by
// read_mesh.
namespace orrery {

// Removes triangles without area, whose face_normal() is zero, because no ray can hit them. Keeps all
// vertices. Returns the number removed.
std::size_t drop_degenerate(TriangleMesh& mesh);

// Position number of each vertex, counted from 0. Vertices at the same position share a number.
using PositionIndices = std::vector<std::uint32_t>;
PositionIndices position_indices_of(const std::vector<Vec3d>& positions);
// Gives different numbers to vertices that share one but differ in `positions`.
void split_position_indices(PositionIndices& places, const std::vector<Vec3d>& positions);

// Returns the number of triangle pairs around a position, which smooth_normals() compares. REQUIRES: `places`
// has a number for each vertex.
std::uint64_t count_pairs(const TriangleMesh& mesh, const PositionIndices& places);

// Computes vertex normals. Each corner gets the mean normal of the triangles around its position whose
// normals differ from its own triangle's by less than `crease_degrees` (in [0, 180]). Normals are weighted by
// the angle at the corner (Thuermer and Wuethrich, Computing Vertex Normals from Polygonal Facets, 1998).
// Splits vertices whose corners differ, merges equal vertices, and removes unused ones. Replaces normals,
// keeps uvs. REQUIRES: `places` has a number for each vertex.
void smooth_normals(TriangleMesh& mesh, double crease_degrees, const PositionIndices& places);
inline void smooth_normals(TriangleMesh& mesh, double crease_degrees) {
  smooth_normals(mesh, crease_degrees, position_indices_of(mesh.positions));
}

// Removes vertices that no triangle uses.
void drop_unused(TriangleMesh& mesh);

}  // namespace orrery
