#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/meshes/mesh_file.h"
#include "tests/support/errors.h"

// Small meshes, and writers of the formats that core/meshes reads.
namespace orrery::test {

using Corners = std::array<Vec3d, 3>;

inline std::vector<Corners> corners_of(const TriangleMesh& mesh) {
  std::vector<Corners> corners;
  for (const auto& t : mesh.triangles)
    corners.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  return corners;
}

// Returns the error of read_mesh, or "accepted".
inline std::string problem(std::string_view bytes, const MeshLimits& limits = {}) {
  return error_of([&] { read_mesh(bytes, limits); });
}

// Returns the cube [-1, 1]^3 with 8 vertices, 12 triangles and outward front faces. The bits of i determine
// the signs of vertex i's coordinates.
inline TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

template <class T>
void append(std::string& out, T value, std::endian order = std::endian::little) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

inline std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
inline std::string words(const Vec3d& v) { return number(v.x) + ' ' + number(v.y) + ' ' + number(v.z); }

inline std::string obj_of(const TriangleMesh& mesh) {
  std::string out = "# a comment\no thing\n";
  for (const Vec3d& p : mesh.positions) out += "v " + words(p) + '\n';
  for (const auto& t : mesh.triangles) {
    out += 'f';
    for (const std::uint32_t i : t) out += ' ' + std::to_string(i + 1);
    out += '\n';
  }
  return out;
}

// Returns ASCII text as UTF-16 with a byte order mark.
inline std::string utf16_of(const std::string& text, std::endian order) {
  std::string out;
  append(out, std::uint16_t{0xfeff}, order);
  for (const char c : text) append(out, static_cast<std::uint16_t>(static_cast<unsigned char>(c)), order);
  return out;
}

inline std::string ply_header(const std::string& format, std::size_t vertices, std::size_t faces) {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
         std::to_string(vertices) + "\nproperty float x\nproperty double y\nproperty float z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}
inline std::string ply_of(const TriangleMesh& mesh) {
  std::string out = ply_header("ascii", mesh.positions.size(), mesh.triangles.size());
  for (const Vec3d& p : mesh.positions) out += words(p) + '\n';
  for (const auto& [a, b, c] : mesh.triangles)
    out += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  return out;
}
inline std::string ply_of(const TriangleMesh& mesh, std::endian order) {
  const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
  std::string out = ply_header(format, mesh.positions.size(), mesh.triangles.size());
  for (const Vec3d& p : mesh.positions) {
    append(out, static_cast<float>(p.x), order);
    append(out, p.y, order);
    append(out, static_cast<float>(p.z), order);
  }
  for (const auto& t : mesh.triangles) {
    append(out, std::uint8_t{3}, order);
    for (const std::uint32_t i : t) append(out, i, order);
  }
  return out;
}

inline std::string ascii_stl_of(const TriangleMesh& mesh) {
  std::string out = "solid a thing\n";
  for (const Corners& corners : corners_of(mesh)) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3d& p : corners) out += "vertex " + words(p) + '\n';
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid a thing\n";
}
inline std::string binary_stl_of(const TriangleMesh& mesh, const std::string& title = "solid or not") {
  std::string out = title;
  out.resize(80);
  append(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Corners& corners : corners_of(mesh)) {
    out.append(12, '\0');
    for (const Vec3d& p : corners)
      for (const double x : {p.x, p.y, p.z}) append(out, static_cast<float>(x));
    out.append(2, '\0');
  }
  return out;
}

inline std::string base64_of(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// Builder of a glTF document. Accessors are numbered in the order of the calls, and other members are added
// as text.
class Gltf {
 public:
  // Adds an accessor and returns its number.
  template <class T>
  int add(const std::vector<T>& values, const std::string& type, int component,
          const std::string& more = "") {
    const int width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type.back() - '0';
    binary_.resize((binary_.size() + 3) / 4 * 4);
    const std::size_t first = binary_.size();
    for (const T& value : values) append(binary_, value);
    views_ += comma(views_) + "{\"buffer\":0,\"byteOffset\":" + std::to_string(first) +
              ",\"byteLength\":" + std::to_string(binary_.size() - first) + "}";
    accessors_ += comma(accessors_) + "{\"bufferView\":" + std::to_string(count_) +
                  ",\"componentType\":" + std::to_string(component) +
                  ",\"count\":" + std::to_string(values.size() / static_cast<std::size_t>(width)) +
                  ",\"type\":\"" + type + "\"" + more + "}";
    return count_++;
  }
  int positions(const std::vector<Vec3d>& values) {
    std::vector<float> floats;
    for (const Vec3d& p : values)
      for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
    return add(floats, "VEC3", 5126);
  }

  // Returns the document as a .gltf file. `rest`: text of the members "nodes", "meshes" and others.
  std::string gltf(const std::string& rest) const {
    return json(rest, ",\"uri\":\"data:application/octet-stream;base64," + base64_of(binary_) + '"');
  }
  // Returns the document with its buffer, binary(), in another file.
  std::string with_file(const std::string& rest, const std::string& uri) const {
    return json(rest, ",\"uri\":\"" + uri + '"');
  }
  const std::string& binary() const { return binary_; }
  std::string glb(const std::string& rest) const {
    std::string text = json(rest, "");
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string binary = binary_;
    binary.resize((binary.size() + 3) / 4 * 4);
    std::string out = "glTF";
    append(out, std::uint32_t{2});
    append(out, static_cast<std::uint32_t>(28 + text.size() + binary.size()));
    append(out, static_cast<std::uint32_t>(text.size()));
    out += "JSON" + text;
    append(out, static_cast<std::uint32_t>(binary.size()));
    out += std::string("BIN\0", 4) + binary;
    return out;
  }

 private:
  static std::string comma(const std::string& list) { return list.empty() ? "" : ","; }
  std::string json(const std::string& rest, const std::string& uri) const {
    return "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":" + std::to_string(binary_.size()) +
           uri + "}],\"bufferViews\":[" + views_ + "],\"accessors\":[" + accessors_ + "]," + rest + "}";
  }

  std::string binary_, views_, accessors_;
  int count_ = 0;
};

// Replaces a part of a .glb file by a longer one, and corrects the lengths in its header.
inline std::string replaced(const std::string& glb, const std::string& part, const std::string& by) {
  std::string json = glb.substr(20, glb.find("BIN") - 24);
  const std::string binary = glb.substr(glb.find("BIN") - 4);
  json.replace(json.find(part), part.size(), by);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  append(out, std::uint32_t{2});
  append(out, static_cast<std::uint32_t>(20 + json.size() + binary.size()));
  append(out, static_cast<std::uint32_t>(json.size()));
  return out + "JSON" + json + binary;
}

// Returns a builder with the mesh as accessors 0 (positions) and 1 (indices), which kOneMesh refers to.
inline Gltf gltf_of(const TriangleMesh& mesh) {
  Gltf gltf;
  gltf.positions(mesh.positions);
  std::vector<std::uint16_t> indices;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) indices.push_back(static_cast<std::uint16_t>(i));
  gltf.add(indices, "SCALAR", 5123);
  return gltf;
}
inline const std::string kOneMesh =
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"nodes":[{"mesh":0}])";

// Returns the CRC-32 of ISO 3309, which ZIP archives store.
inline std::uint32_t crc32_of(std::string_view bytes) {
  std::uint32_t crc = ~0u;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

// Builder of a ZIP archive. Entries are stored, unless their packed bytes are given.
class Zip {
 public:
  // `packed`: bytes in the archive, if they differ from the content. `method`: 0 stored, 8 deflated.
  Zip& add(const std::string& name, const std::string& content) { return add(name, content, content, 0); }
  Zip& add(const std::string& name, const std::string& content, const std::string& packed,
           std::uint16_t method) {
    std::string fields;  // members that both headers contain
    append(fields, method);
    append(fields, std::uint32_t{0});  // date
    for (const std::size_t value : {std::size_t{crc32_of(content)}, packed.size(), content.size()})
      append(fields, static_cast<std::uint32_t>(value));
    append(fields, static_cast<std::uint16_t>(name.size()));
    append(fields, std::uint16_t{0});
    const auto first = static_cast<std::uint32_t>(bytes_.size());
    bytes_ += std::string("PK\3\4\x14\0\0\0", 8) + fields + name + packed;
    directory_ += std::string("PK\1\2\x14\0\x14\0\0\0", 10) + fields + std::string(10, '\0');
    append(directory_, first);
    directory_ += name;
    ++count_;
    return *this;
  }
  std::string bytes() const {
    std::string out = bytes_ + directory_ + std::string("PK\5\6\0\0\0\0", 8);
    append(out, count_);
    append(out, count_);
    append(out, static_cast<std::uint32_t>(directory_.size()));
    append(out, static_cast<std::uint32_t>(bytes_.size()));
    return out + std::string(2, '\0');
  }

 private:
  std::string bytes_, directory_;
  std::uint16_t count_ = 0;
};

// Returns the element "mesh" of 3MF. `more`: attributes by triangle.
inline std::string three_mf_mesh(const TriangleMesh& mesh, const std::vector<std::string>& more = {}) {
  std::string out = "<mesh><vertices>";
  for (const Vec3d& p : mesh.positions)
    out += "<vertex x=\"" + number(p.x) + "\" y=\"" + number(p.y) + "\" z=\"" + number(p.z) + "\"/>";
  out += "</vertices><triangles>";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    out += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" +
           std::to_string(c) + "\" " + (i < more.size() ? more[i] : "") + "/>";
  }
  return out + "</triangles></mesh>";
}
// Returns a model part of 3MF.
inline std::string three_mf_model(const std::string& resources, const std::string& items,
                                  const std::string& attributes = "") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" " +
         attributes + "><resources>" + resources + "</resources><build>" + items + "</build></model>";
}
inline std::string three_mf_of(const std::string& resources, const std::string& items,
                               const std::string& attributes = "") {
  return Zip().add("3D/3dmodel.model", three_mf_model(resources, items, attributes)).bytes();
}
inline std::string three_mf_of(const TriangleMesh& mesh) {
  return three_mf_of("<object id=\"1\">" + three_mf_mesh(mesh) + "</object>", "<item objectid=\"1\"/>");
}

}  // namespace orrery::test
