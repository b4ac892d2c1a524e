#include <bit>

#include "core/meshes/formats.h"
#include "core/meshes/text.h"
#include "core/meshes/vertex_list.h"

// Stereolithography files (3D Systems, 1989). Stored facet normals are ignored, because many programs write
// 0. The order of the corners determines the front side.
namespace orrery {
namespace {

// Binary format, little-endian: 80 arbitrary bytes, the number of facets, then 12 floats and 2 bytes per
// facet.
constexpr std::size_t kHeader = 84, kFacet = 50, kCorner = 12;
constexpr std::size_t kMaxTrailing = 4096;  // bytes after the last triangle, as some programs write

std::uint32_t little_endian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

class Builder {
 public:
  explicit Builder(const MeshLimits& limits) : limits_(limits) {}

  void reserve(std::size_t triangles) { triangles_.reserve(triangles); }
  void add(const std::array<Vec3d, 3>& corners) {
    check_triangles(triangles_.size() + 1, limits_);
    auto& triangle = triangles_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertices_.add({corners[k], {}, {}});
    check_vertices(vertices_.size(), limits_);
  }
  TriangleMesh take() {
    TriangleMesh mesh = vertices_.take();
    mesh.triangles = std::move(triangles_);
    return mesh;
  }

 private:
  const MeshLimits& limits_;
  VertexList vertices_{false, false};
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

TriangleMesh read_binary(std::string_view bytes, const MeshLimits& limits) {
  const std::size_t count = binary_stl_triangles(bytes);
  check_triangles(count, limits);
  Builder builder(limits);
  builder.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* facet = bytes.data() + kHeader + i * kFacet + kCorner;  // skips the normal
    std::array<Vec3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto value = [&](std::size_t c) -> double {
        return std::bit_cast<float>(little_endian(facet + k * kCorner + c * 4));
      };
      corners[k] = {value(0), value(1), value(2)};
      if (!is_position(corners[k]))
        fail_at("facet " + std::to_string(i) + " at byte " + std::to_string(kHeader + i * kFacet),
                position_problem(corners[k]));
    }
    builder.add(corners);
  }
  TriangleMesh mesh = builder.take();
  if (const std::size_t end = kHeader + count * kFacet; end < bytes.size())
    mesh.notes.push_back(grouped(bytes.size() - end) + " bytes after the last triangle were skipped");
  return mesh;
}

void expect(TextReader& text, std::string_view wanted) {
  const std::string_view word = text.word();
  if (!is_keyword(word, wanted))
    text.fail("must be " + excerpt(wanted) + " (got " +
              (word.empty() ? "the end of the file" : excerpt(word)) + ")");
}

// Reads "facet normal i j k  outer loop  vertex x y z (3 times)  endloop  endfacet" after its first word.
std::array<Vec3d, 3> read_facet(TextReader& text) {
  expect(text, "normal");
  for (int i = 0; i < 3; ++i) text.word();
  expect(text, "outer");
  expect(text, "loop");
  std::array<Vec3d, 3> corners;
  for (Vec3d& corner : corners) {
    expect(text, "vertex");
    corner.x = text.number("x");
    corner.y = text.number("y");
    corner.z = text.number("z");
    if (!is_position(corner)) text.fail(position_problem(corner));
  }
  expect(text, "endloop");
  expect(text, "endfacet");
  return corners;
}

// Reads solids. Each is "solid" with any text on the same line, facets, and "endsolid" with any text on the
// same line.
TriangleMesh read_ascii(std::string_view bytes, const MeshLimits& limits) {
  TextReader text(bytes);
  Builder builder(limits);
  bool inside = false;
  for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
    if (is_keyword(word, inside ? "endsolid" : "solid")) {
      inside = !inside;
      text.next_line();
    } else if (inside && is_keyword(word, "facet")) {
      builder.add(read_facet(text));
    } else {
      text.fail(std::string("must be ") + (inside ? "\"facet\" or \"endsolid\"" : "\"solid\"") + " (got " +
                excerpt(word) + ")");
    }
  }
  if (inside) text.fail("must be \"endsolid\" (got the end of the file)");
  return builder.take();
}

}  // namespace

std::size_t binary_stl_triangles(std::string_view bytes) {
  if (bytes.size() <= kHeader) return 0;
  const std::size_t count = little_endian(bytes.data() + kHeader - 4);
  const std::size_t end = kHeader + count * kFacet;
  return bytes.size() >= end && bytes.size() - end <= kMaxTrailing ? count : 0;
}

TriangleMesh read_stl(std::string_view bytes, const MeshLimits& limits) {
  return binary_stl_triangles(bytes) > 0 ? read_binary(bytes, limits) : read_ascii(bytes, limits);
}

}  // namespace orrery
