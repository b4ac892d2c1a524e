#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

namespace orrery {

// Triangle mesh, in the axes and units of its file (taken as metres).
struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // anticlockwise seen from the front
  std::vector<Vec3d> normals;                           // per position, unit; or empty
  std::vector<std::array<double, 2>> uvs;               // per position, (0, 0) lower left; or empty
};

// Largest magnitude of a coordinate, the same as for scenes.
inline constexpr double kMaxMeshCoordinate = 1e12;

// Limits on the content of a file; at most 2^31 - 1 each.
struct MeshLimits {
  std::size_t vertices = 10'000'000, triangles = 10'000'000;
};

enum class MeshFormat { obj, ply, stl, gltf };

// Detects the format from the content: glTF and PLY by their first bytes, binary STL by its size, ASCII STL
// and OBJ by their first word. Throws InputError if no format matches.
MeshFormat mesh_format(std::string_view bytes);

// Reads an OBJ, PLY (ASCII, binary of either byte order), STL (ASCII, binary) or glTF 2.0 file (.glb, or
// .gltf with data: URIs). Detects the format from the content. Reads nothing except `bytes`; the same bytes
// give the same mesh.
//
// Merges all geometry of the file into one mesh; ignores materials and the like. Polygons become fans about
// their first corner, which is correct for convex ones. Keeps triangles without area. Drops normals and uvs
// that some vertices lack. Normals of length 0 are computed from the faces around their vertex. STL has
// neither normals nor uvs, and its equal corners become one vertex. The v of glTF is flipped, so that (0, 0)
// is at the lower left.
//
// Throws InputError (pointer "") with the place in the file, the value and the limit. Checks every size in a
// file against `limits` and the available bytes before it allocates memory. Throws Cancelled. Thread-safe.
TriangleMesh read_mesh(std::string_view bytes, const MeshLimits& limits = {});

}  // namespace orrery
