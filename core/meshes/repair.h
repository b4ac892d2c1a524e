#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/meshes/mesh_file.h"

// Repairs meshes before use. The functions preserve the order of triangles. They may throw Cancelled, after
// which the mesh must not be used. Calls for different meshes may run on different threads. REQUIRES: valid
// indices and finite coordinates, as returned by read_mesh.
namespace orrery {

// Removes triangles without area (face_normal() is 0), which no ray can hit. Keeps all vertices. Returns the
// number of removed triangles.
std::size_t drop_degenerate(TriangleMesh& mesh);

// Position number of each vertex, counted from 0. Vertices at the same position have the same number.
using PositionIndices = std::vector<std::uint32_t>;
PositionIndices position_indices_of(const std::vector<Vec3d>& positions);
// Renumbers the vertices. Two vertices have the same number afterwards only if they had the same number
// before and have equal `positions`.
void split_position_indices(PositionIndices& places, const std::vector<Vec3d>& positions);

// Returns the number of pairs of corners at the same position: the sum of n^2 over positions with n corners.
// smooth_normals() compares these pairs. REQUIRES: `places` has a number for each vertex.
std::uint64_t count_pairs(const TriangleMesh& mesh, const PositionIndices& places);

// Replaces the vertex normals. The normal of a corner is a mean over the triangles with a corner at the same
// position. The mean includes the corner's own triangle, and the triangles whose normals differ from its
// normal by less than `crease_degrees`, in [0, 180]. Triangle normals are weighted by the angle at the
// position (Thuermer and Wuethrich, Computing Vertex Normals from Polygonal Facets, 1998). Splits vertices
// whose corners have different normals, merges equal vertices, and removes unused vertices. Keeps uvs.
// REQUIRES: `places` has a number for each vertex.
void smooth_normals(TriangleMesh& mesh, double crease_degrees, const PositionIndices& places);
inline void smooth_normals(TriangleMesh& mesh, double crease_degrees) {
  smooth_normals(mesh, crease_degrees, position_indices_of(mesh.positions));
}

// Returns whether the triangles enclose a volume: each edge from one position to another has as many
// triangles in one direction as in the other.
bool is_watertight(std::span<const std::array<std::uint32_t, 3>> triangles, const PositionIndices& places);

// Removes vertices that no triangle uses.
void drop_unused(TriangleMesh& mesh);

}  // namespace orrery
