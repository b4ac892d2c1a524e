#pragma once

#include <cstddef>
#include <cstdint>

#include "core/meshes/mesh_file.h"

// What a mesh may need before it is used. Each function keeps the order of what stays.
// REQUIRES: indices within positions, coordinates finite; as read_mesh gives them.
namespace orrery {

// Takes out the triangles without area, whose normal face_normal() is zero: no ray can
// meet them. Returns how many. Vertices stay.
std::size_t drop_degenerate(TriangleMesh& mesh);

// The place of each vertex: vertices that stand together have the same number. Numbers begin at 0.
using PositionIndices = std::vector<std::uint32_t>;
PositionIndices position_indices_of(const std::vector<Vec3d>& positions);
// Vertices that share a place, but stand apart in `positions`, get different ones.
void split_position_indices(PositionIndices& places, const std::vector<Vec3d>& positions);

// Pairs of triangles around one place, which smooth_normals() compares. REQUIRES: a place for each vertex.
std::uint64_t count_pairs(const TriangleMesh& mesh, const PositionIndices& places);

// Gives the mesh vertex normals: at each corner, the mean of the normals of the triangles around its place
// whose normals differ from its own triangle's by less than `crease_degrees` (in [0, 180]), each weighted by
// its angle there (Thuermer and Wuethrich, Computing Vertex Normals from Polygonal Facets, 1998). A vertex
// whose corners differ becomes several; vertices that are equal become one, and those that no triangle uses
// go. Replaces normals, keeps uvs. REQUIRES: a place for each vertex.
void smooth_normals(TriangleMesh& mesh, double crease_degrees, const PositionIndices& places);
inline void smooth_normals(TriangleMesh& mesh, double crease_degrees) {
  smooth_normals(mesh, crease_degrees, position_indices_of(mesh.positions));
}

// Takes out the vertices that no triangle uses.
void drop_unused(TriangleMesh& mesh);

}  // namespace orrery
