#include <bit>
#include <optional>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"
#include "core/meshes/vertex_list.h"

// Stereolithography files (3D Systems, 1989). Stored facet normals are ignored, because many programs write
// 0. The order of the corners determines the front side. Colours of facets follow the extensions of VisCAM
// and Materialise Magics.
namespace orrery {
namespace {

// Binary format, little-endian: 80 arbitrary bytes, the number of facets, then 12 floats and 2 bytes per
// facet.
constexpr std::size_t kHeader = 84, kFacet = 50, kCorner = 12;
constexpr std::size_t kMaxTrailing = 4096;  // bytes after the last triangle, as some programs write

std::uint32_t little_endian(const char* bytes, int size = 4) {
  std::uint32_t value = 0;
  for (int i = size - 1; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// Colours of the facets of a binary file, which are in their last two bytes. VisCAM: bit 15 marks a colour,
// with blue in the lowest 5 bits, then green and red. Magics: the header has "COLOR=" and the 4 bytes of the
// colour of the object, and bit 15 marks facets of that colour. Others have their own, with red in the lowest
// bits.
class FacetColors {
 public:
  // Reads the bytes of all facets. Many programs write 0 or other data there, so a file has colours only if
  // some bytes are not 0 and, without the header of Magics, if bit 15 is set where they are not 0.
  FacetColors(std::string_view bytes, std::size_t count) : bytes_(bytes) {
    constexpr std::string_view kKey = "COLOR=";
    constexpr std::size_t kHeaderText = 80, kColor = 4;
    const std::size_t at = bytes.substr(0, kHeaderText - kColor).find(kKey);
    if (at != bytes.npos) {
      const auto channel = [&](std::size_t k) {
        return static_cast<unsigned char>(bytes[at + kKey.size() + k]) / 255.0;
      };
      object_ = decode_srgb(Vec3d(channel(0), channel(1), channel(2)));
    }
    for (std::size_t i = 0; i < count; ++i) {
      checkpoint(i);
      const std::uint32_t word = word_of(i);
      if (word != 0) exist_ = true;
      if (word != 0 && !object_ && !(word & kMark)) {
        exist_ = false;
        return;
      }
    }
  }

  bool exist() const { return exist_; }

  // Returns the colour of a facet. Facets without a colour are white. Codes are those of sRGB. REQUIRES:
  // exist().
  Vec3d of(std::size_t facet) const {
    const std::uint32_t word = word_of(facet);
    const auto channel = [&](int shift) { return (word >> shift & 31) / 31.0; };
    if (object_) return word & kMark ? *object_ : decode_srgb(Vec3d(channel(0), channel(5), channel(10)));
    return word & kMark ? decode_srgb(Vec3d(channel(10), channel(5), channel(0))) : Vec3d(1);
  }

 private:
  static constexpr std::uint32_t kMark = 1 << 15;

  std::uint32_t word_of(std::size_t facet) const {
    return little_endian(bytes_.data() + kHeader + (facet + 1) * kFacet - 2, 2);
  }

  std::string_view bytes_;
  std::optional<Vec3d> object_;  // colour of the object in a file of Magics
  bool exist_ = false;
};

class Builder {
 public:
  Builder(const MeshLimits& limits, bool with_colors)
      : limits_(limits), vertices_(false, false, with_colors) {}

  void reserve(std::size_t triangles) { triangles_.reserve(triangles); }
  void add(const std::array<Vec3d, 3>& corners, const Vec3d& color = {}) {
    check_triangles(triangles_.size() + 1, limits_);
    auto& triangle = triangles_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertices_.add({corners[k], {}, {}, color});
    check_vertices(vertices_.size(), limits_);
  }
  TriangleMesh take() {
    TriangleMesh mesh = vertices_.take();
    mesh.triangles = std::move(triangles_);
    return mesh;
  }

 private:
  const MeshLimits& limits_;
  VertexList vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

TriangleMesh read_binary(std::string_view bytes, const MeshLimits& limits) {
  const std::size_t count = binary_stl_triangles(bytes);
  check_triangles(count, limits);
  const FacetColors colors(bytes, count);
  Builder builder(limits, colors.exist());
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
    builder.add(corners, colors.exist() ? colors.of(i) : Vec3d());
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
  Builder builder(limits, false);
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
