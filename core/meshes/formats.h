#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/math/decode_srgb.h"
#include "core/meshes/model.h"

// Declarations shared by the readers of mesh formats.
namespace orrery {

// Reads a file of one format. `bytes` is the whole file without a byte order mark. Normals need not have unit
// length: read_model() normalizes them. Throws the exceptions of read_model().
MeshModel read_obj(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby);
TriangleMesh read_ply(std::string_view bytes, const MeshLimits& limits);
TriangleMesh read_stl(std::string_view bytes, const MeshLimits& limits);
MeshModel read_gltf(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby,
                    const ModelState& state);
MeshModel read_three_mf(std::string_view bytes, const MeshLimits& limits);

// Returns true for a ZIP archive with a model part of 3MF. Throws InputError if an archive cannot be read.
bool is_three_mf(std::string_view bytes);

// Returns the number of triangles of a binary STL, or 0 for any other file. The file must have room for the
// count in the header, and may have a few bytes after the last triangle. A text file has no room, because its
// bytes would encode a count of at least 150 million triangles, or more than 7 GB.
std::size_t binary_stl_triangles(std::string_view bytes);

// Returns true if `word` equals the lower-case `keyword`, ignoring case.
bool is_keyword(std::string_view word, std::string_view keyword);

[[noreturn]] inline void fail_at(const std::string& place, const std::string& detail) {
  throw InputError("", place + ": " + detail);
}

inline void check_vertices(std::size_t count, const MeshLimits& limits) {
  if (count > limits.vertices)
    throw InputError("", "mesh has at least " + grouped(count) + " vertices (limit " +
                             grouped(limits.vertices) + ", mesh_vertices)");
}
inline void check_triangles(std::size_t count, const MeshLimits& limits) {
  if (count > limits.triangles)
    throw InputError("", "mesh has at least " + grouped(count) + " triangles (limit " +
                             grouped(limits.triangles) + ", mesh_triangles)");
}

inline bool is_finite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Decodes a colour of sRGB codes / 255, each in [0, 1].
inline Vec3d decode_srgb(const Vec3d& encoded) {
  const auto decode = [](double x) -> double { return decode_srgb(static_cast<float>(x)); };
  return {decode(encoded.x), decode(encoded.y), decode(encoded.z)};
}

// Returns the shortest decimal that converts back to the same number.
inline std::string text_of(double x) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}
inline std::string text_of(const Vec3d& v) {
  return '(' + text_of(v.x) + ", " + text_of(v.y) + ", " + text_of(v.z) + ')';
}

// Returns true if each coordinate is at most kMaxMeshCoordinate in magnitude.
inline bool is_position(const Vec3d& v) {
  const auto in_range = [](double x) { return std::abs(x) <= kMaxMeshCoordinate; };
  return in_range(v.x) && in_range(v.y) && in_range(v.z);
}
// Returns the error text for a position that is out of range. `place` follows the value in the text.
inline std::string position_problem(const Vec3d& got, const std::string& place = "") {
  return "coordinates must be at most " + text_of(kMaxMeshCoordinate) + " m in magnitude (got " +
         text_of(got) + place + ")";
}

}  // namespace orrery
