#include "core/meshes/mesh_file.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/model_archive.h"
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

// Returns UTF-16 text with a byte order mark as UTF-8, and other bytes unchanged. Unpaired surrogates become
// U+FFFD.
std::string utf8_of_utf16(std::string_view bytes) {
  const bool big = bytes.starts_with("\xfe\xff");
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]),
               second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big ? first << 8 | second : second << 8 | first);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    checkpoint(i);
    std::uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xdc00 && i + 3 < bytes.size() && (unit(i + 2) & 0xfc00) == 0xdc00) {
      code = 0x10000 + ((code - 0xd800) << 10) + (unit(i + 2) - 0xdc00);
      i += 2;
    } else if (code >= 0xd800 && code < 0xe000) {
      code = 0xfffd;
    }
    const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
      add(code);
    } else if (code < 0x800) {
      add(0xc0 | code >> 6);
      add(0x80 | (code & 0x3f));
    } else {
      if (code < 0x10000) {
        add(0xe0 | code >> 12);
      } else {
        add(0xf0 | code >> 18);
        add(0x80 | (code >> 12 & 0x3f));
      }
      add(0x80 | (code >> 6 & 0x3f));
      add(0x80 | (code & 0x3f));
    }
  }
  return text;
}
bool is_utf16(std::string_view bytes) {
  return bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
}

// Returns the notes for an error message: the first ones, up to a length.
std::string joined(const std::vector<std::string>& notes) {
  constexpr std::size_t kMaxText = 250;
  std::string text;
  for (std::size_t i = 0; i < notes.size(); ++i) {
    if (text.size() + notes[i].size() > kMaxText)
      return text + "; " + grouped(notes.size() - i) + " more notes";
    text += "; " + notes[i];
  }
  return text;
}

MeshModel read_as(MeshFormat format, std::string_view bytes, const MeshLimits& limits,
                  const ReadNearby& nearby, const ModelState& state) {
  if (state != ModelState() && format != MeshFormat::gltf)
    throw InputError("", "must be a glTF file to have a pose at a time or a variant (got " +
                             std::string(name_of(format)) + ")");
  switch (format) {
    case MeshFormat::obj: return read_obj(bytes, limits, nearby);
    case MeshFormat::ply: return {read_ply(bytes, limits), {}, {}};
    case MeshFormat::stl: return {read_stl(bytes, limits), {}, {}};
    case MeshFormat::gltf: return read_gltf(bytes, limits, nearby, state);
    case MeshFormat::three_mf: return read_three_mf(bytes, limits);
  }
  return {};
}

// Reads the model in an archive. Adds its path to errors.
MeshModel read_archived(const ModelArchive& archive, const MeshLimits& limits, const ModelState& state) {
  const std::string bytes = archive.read_model_file();
  try {
    return read_model(bytes, limits, archive.nearby(), state);
  } catch (const InputError& error) {
    fail_at(excerpt(archive.model_name(), 80), error.problems().front().detail);
  }
}

}  // namespace

std::string_view name_of(MeshFormat format) {
  constexpr std::array<std::string_view, 5> kNames{"obj", "ply", "stl", "gltf", "3mf"};
  return kNames[static_cast<std::size_t>(format)];
}

MeshFormat mesh_format(std::string_view bytes) {
  if (bytes.starts_with("glTF")) return MeshFormat::gltf;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::ply;
  if (is_three_mf(bytes)) return MeshFormat::three_mf;
  if (binary_stl_triangles(bytes) > 0) return MeshFormat::stl;
  if (is_utf16(bytes)) return mesh_format(utf8_of_utf16(bytes));
  const std::string_view word = first_word(without_byte_order_mark(bytes));
  if (word.starts_with('{')) return MeshFormat::gltf;
  if (is_keyword(word, "solid")) return MeshFormat::stl;
  if (std::find(std::begin(kObjWords), std::end(kObjWords), word) != std::end(kObjWords))
    return MeshFormat::obj;
  throw InputError("",
                   "must be an OBJ, PLY, STL (84 + 50 n bytes if binary), 3MF or glTF file, or a ZIP archive "
                   "of one (got " +
                       std::to_string(bytes.size()) + " bytes that begin with " + excerpt(bytes) + ")");
}

MeshModel read_model(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby,
                     const ModelState& state) {
  if (ModelArchive::is_archive(bytes)) return read_archived(ModelArchive(bytes), limits, state);
  if (is_utf16(bytes) && binary_stl_triangles(bytes) == 0)
    return read_model(utf8_of_utf16(bytes), limits, nearby, state);
  const MeshFormat format = mesh_format(bytes);
  const bool is_text = binary_stl_triangles(bytes) == 0;  // a binary STL may begin with any bytes
  MeshModel model = read_as(format, is_text ? without_byte_order_mark(bytes) : bytes, limits, nearby, state);
  if (model.mesh.triangles.empty())
    throw InputError("", "mesh must have at least 1 triangle (got 0" + joined(model.mesh.notes) + ")");
  finish_normals(model.mesh);
  model.format = format;
  return model;
}

TriangleMesh read_mesh(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby) {
  return whole_of(read_model(bytes, limits, nearby).mesh);
}

}  // namespace orrery
