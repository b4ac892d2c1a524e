#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec3.h"

// core/meshes reads mesh files and repairs the meshes. Threads may process different meshes at the same time.
// Functions throw InputError for invalid files, Cancelled, and std::bad_alloc.
namespace orrery {

// Consecutive triangles of a mesh with the same material.
struct MeshPart {
  std::uint32_t first_triangle;
  std::int32_t material = -1;  // number in the file, or -1
  // Whether the vertices of the part have these attributes. Otherwise, the entries of the mesh are unused.
  bool has_normals = false, has_uvs = false, has_colors = false;
};

// Triangle mesh, in the axes and units of the file. One unit is taken as one metre.
struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // anticlockwise seen from the front
  std::vector<Vec3d> normals;                           // per position, unit; or empty
  std::vector<std::array<double, 2>> uvs;               // per position, (0, 0) lower left; or empty
  std::vector<Vec3d> colors = {};                       // per position, linear, 0 to 1; or empty
  // Parts by ascending triangle, the first of which begins at triangle 0. Empty: one part without a material
  // that has the attributes whose lists are not empty.
  std::vector<MeshPart> parts = {};
  // Sentences without a full stop about contents of the file that the mesh lacks, or that were repaired.
  std::vector<std::string> notes = {};
};

// Largest absolute coordinate, in metres. Equals the limit for scenes.
inline constexpr double kMaxMeshCoordinate = 1e12;

// Limits on the content of a file. REQUIRES: each is at most 2^31 - 1.
struct MeshLimits {
  std::size_t vertices = 10'000'000, triangles = 10'000'000;
};

// Returns the bytes of a file that a mesh file names, by its name relative to the mesh file. Throws
// InputError (pointer "") if there is no such file or it must not be read.
using ReadNearby = std::function<std::string(const std::string& name)>;

enum class MeshFormat { obj, ply, stl, gltf, three_mf };
std::string_view name_of(MeshFormat format);  // "obj", "ply", "stl", "gltf" or "3mf"

// Detects the format from the content: glTF and PLY by their first bytes, 3MF by its archive, binary STL by
// its size, ASCII STL and OBJ by their first word. Throws InputError if no format matches, as for other
// archives. Throws Cancelled.
MeshFormat mesh_format(std::string_view bytes);

// Reads an OBJ, PLY (ASCII, binary of either byte order), STL (ASCII, binary), 3MF or glTF 2.0 file (.glb, or
// .gltf). Detects the format from the content. Text may be UTF-8 or, with a byte order mark, UTF-16. Buffers
// of glTF files that are neither in the file nor in data: URIs are read by `nearby`; without it, they are an
// error. Material libraries and images are read by `nearby`, too; without it, they give notes. The same bytes
// give the same mesh.
//
// Merges all geometry of the file into one mesh without parts. Its notes name the contents that it lacks,
// such as animations. read_model() in core/meshes/model.h reads the parts and their materials, too. Divides
// polygons into triangles: see divide_polygons(). Keeps triangles without area. Keeps normals only if all
// vertices have normals, and keeps uvs only if all vertices have uvs. Replaces zero-length normals with
// normals computed from the faces around the vertex. A mesh from STL has no normals and no uvs. Corners of an
// STL file at equal positions, and of one colour, become one vertex. Replaces v of glTF by 1 - v, so that (0,
// 0) is at the lower left.
//
// Reads a ZIP archive as read_model() does.
//
// Throws InputError (pointer "") with the place in the file, the value and the limit. Before allocating
// memory, checks every size in the file against `limits` and the number of available bytes. Throws Cancelled.
// Thread-safe.
TriangleMesh read_mesh(std::string_view bytes, const MeshLimits& limits = {}, const ReadNearby& nearby = {});

}  // namespace orrery
