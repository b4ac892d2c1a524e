#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

namespace orrery {

// What a mesh file holds, in the file's own units (taken as metres) and axes.
struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // anticlockwise from the front
  std::vector<Vec3d> normals;                           // one a position, unit; or none
  std::vector<std::array<double, 2>> uvs;               // one a position, (0, 0) lower left; or none
};

// Largest coordinate of a position, in magnitude: that of a scene.
inline constexpr double kMaxMeshCoordinate = 1e12;

// What a file may hold; at most 2^31 - 1 each.
struct MeshLimits {
  std::size_t vertices = 10'000'000, triangles = 10'000'000;
};

enum class MeshFormat { obj, ply, stl, gltf };

// The format of a file, told by its content: glTF and PLY by their first bytes, binary STL by its size, ASCII
// STL and OBJ by their first word. Throws InputError if it is none of them.
MeshFormat mesh_format(std::string_view bytes);

// Reads an OBJ, a PLY (ASCII, binary of either byte order), an STL (ASCII, binary) or a glTF 2.0 file (.glb,
// or .gltf whose buffers are data: URIs), told by its content. Nothing but `bytes` is read; the same bytes
// give the same mesh.
//
// All that the file places becomes one mesh; materials and the like are left aside. Polygons become fans
// about their first corner, which is right for convex ones. Triangles without area stay. Normals and uvs that
// not every vertex has are left out; a normal of length 0 takes the direction of the faces around its vertex.
// STL gives neither, and its equal corners are one vertex; glTF's uvs are turned to have (0, 0) at the lower
// left.
//
// Throws InputError (pointer "") with the place in the file, the value and the limit. Every size that a file
// states is checked against `limits` and against the bytes that are there before memory is taken for it.
TriangleMesh read_mesh(std::string_view bytes, const MeshLimits& limits = {});

}  // namespace orrery
