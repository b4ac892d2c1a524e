#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"

// What the readers of this room share.
namespace orrery {

// Each takes a whole file of its format, without a byte order mark. Normals come as the file has them.
TriangleMesh read_obj(std::string_view bytes, const MeshLimits& limits);
TriangleMesh read_ply(std::string_view bytes, const MeshLimits& limits);
TriangleMesh read_stl(std::string_view bytes, const MeshLimits& limits);
TriangleMesh read_gltf(std::string_view bytes, const MeshLimits& limits);

// The number of triangles of a binary STL, whose size follows from it; 0 for anything else. No text is one:
// at that place it states at least 150 million.
std::size_t binary_stl_triangles(std::string_view bytes);

// Whether `word` is `keyword` (in lower case), in capitals or not.
bool is_keyword(std::string_view word, std::string_view keyword);

[[noreturn]] inline void fail_at(const std::string& place, const std::string& detail) {
  throw InputError("", place + ": " + detail);
}

inline void check_vertices(std::size_t count, const MeshLimits& limits) {
  if (count > limits.vertices)
    throw InputError("", "expected at most " + std::to_string(limits.vertices) + " vertices, got " +
                             std::to_string(count) + " or more");
}
inline void check_triangles(std::size_t count, const MeshLimits& limits) {
  if (count > limits.triangles)
    throw InputError("", "expected at most " + std::to_string(limits.triangles) + " triangles, got " +
                             std::to_string(count) + " or more");
}

inline bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The shortest decimals that give the number back.
inline std::string text_of(double x) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}
inline std::string text_of(const Vec3d& v) {
  return '(' + text_of(v.x) + ", " + text_of(v.y) + ", " + text_of(v.z) + ')';
}

// Whether each coordinate is a number of at most kMaxMeshCoordinate.
inline bool is_position(const Vec3d& v) {
  const auto in_range = [](double x) { return std::abs(x) <= kMaxMeshCoordinate; };
  return in_range(v.x) && in_range(v.y) && in_range(v.z);
}
inline std::string expected_position(const Vec3d& got) {
  return "expected coordinates of at most " + text_of(kMaxMeshCoordinate) + " in magnitude, got " +
         text_of(got);
}

}  // namespace orrery
