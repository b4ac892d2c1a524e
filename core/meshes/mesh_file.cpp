#include "core/meshes/mesh_file.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr std::string_view kObjWords[] = {"v", "vt", "vn", "vp", "f",      "l",      "p",
                                          "g", "o",  "s",  "mg", "usemtl", "mtllib", "cstype"};

// Returns the first word that is not in a line beginning with "#", or an empty string.
std::string_view first_word(std::string_view bytes) {
  TextReader text(bytes);
  do {
    const std::string_view word = text.word_of_line();
    if (!word.empty() && word[0] != '#') return word;
  } while (text.next_line());
  return {};
}

std::string_view without_byte_order_mark(std::string_view bytes) {
  return bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
}

// Normalizes the normals. A normal of length 0 becomes the area-weighted mean of the face normals around its
// vertex, or (0, 0, 1) if that mean is 0.
void finish_normals(TriangleMesh& mesh) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    checkpoint(i);
    mesh.normals[i] = safe_normalize(mesh.normals[i]);
    if (mesh.normals[i] == Vec3d()) missing.push_back(i);
  }
  if (missing.empty()) return;
  for (const auto& t : mesh.triangles) {
    checkpoint();
    const Vec3d &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const Vec3d area = cross(b - a, c - a);
    for (const std::uint32_t i : t)
      if (std::binary_search(missing.begin(), missing.end(), i)) mesh.normals[i] = mesh.normals[i] + area;
  }
  for (const std::size_t i : missing) {
    mesh.normals[i] = safe_normalize(mesh.normals[i]);
    // The triangles around the vertex have no area, or their normals cancel.
    if (mesh.normals[i] == Vec3d()) mesh.normals[i] = {0, 0, 1};
  }
}

TriangleMesh read_as(MeshFormat format, std::string_view bytes, const MeshLimits& limits) {
  switch (format) {
    case MeshFormat::obj: return read_obj(bytes, limits);
    case MeshFormat::ply: return read_ply(bytes, limits);
    case MeshFormat::stl: return read_stl(bytes, limits);
    case MeshFormat::gltf: return read_gltf(bytes, limits);
  }
  return {};
}

}  // namespace

MeshFormat mesh_format(std::string_view bytes) {
  if (bytes.starts_with("glTF")) return MeshFormat::gltf;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::ply;
  if (binary_stl_triangles(bytes) > 0) return MeshFormat::stl;
  const std::string_view word = first_word(without_byte_order_mark(bytes));
  if (word.starts_with('{')) return MeshFormat::gltf;
  if (is_keyword(word, "solid")) return MeshFormat::stl;
  if (std::find(std::begin(kObjWords), std::end(kObjWords), word) != std::end(kObjWords))
    return MeshFormat::obj;
  throw InputError("", "must be an OBJ, PLY, STL (84 + 50 n bytes if binary) or glTF file (got " +
                           std::to_string(bytes.size()) + " bytes that begin with " + excerpt(bytes) + ")");
}

TriangleMesh read_mesh(std::string_view bytes, const MeshLimits& limits) {
  const MeshFormat format = mesh_format(bytes);
  const bool is_text = binary_stl_triangles(bytes) == 0;  // a binary STL may begin with any bytes
  TriangleMesh mesh = read_as(format, is_text ? without_byte_order_mark(bytes) : bytes, limits);
  if (mesh.triangles.empty()) throw InputError("", "mesh must have at least 1 triangle (got 0)");
  finish_normals(mesh);
  return mesh;
}

}  // namespace orrery
