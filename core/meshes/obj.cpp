#include <algorithm>
#include <map>
#include <set>

#include "core/base/number.h"
#include "core/meshes/formats.h"
#include "core/meshes/index_table.h"
#include "core/meshes/mesh_parts.h"
#include "core/meshes/mtl.h"
#include "core/meshes/polygons.h"
#include "core/meshes/text.h"

// Wavefront OBJ: reads v, vt, vn, f, usemtl and mtllib, and skips all other keywords (groups, lines,
// free-form curves). Format: Wavefront, Advanced Visualizer Manual, appendix B1. Colours of vertices, as in
// MeshLab and ZBrush, follow the coordinates.
namespace orrery {
namespace {

constexpr std::size_t kMaxMaterials = 4096, kMaxLibraryLines = 100;

// Indices of a corner into the lists of positions, uvs and normals, counted from 0.
struct Corner {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t position = kNone, uv = kNone, normal = kNone;

  bool operator==(const Corner&) const = default;
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby)
      : text_(bytes, true), limits_(limits), nearby_(nearby) {}

  MeshModel read() {
    start_part(0, -1, parts_);
    std::string_view keyword;
    do {
      keyword = text_.word_of_line();
      if (keyword == "v") {
        read_position();
      } else if (keyword == "vn") {
        normals_.push_back(read_three("vn"));
      } else if (keyword == "vt") {
        uvs_.push_back(read_uv());
      } else if (keyword == "f") {
        read_face();
      } else if (keyword == "usemtl") {
        start_part(triangles_.size(), material_index(text_.rest_of_line()), parts_);
      } else if (keyword == "mtllib") {
        if (libraries_.size() < kMaxLibraryLines) libraries_.insert(std::string(text_.rest_of_line()));
      } else {
        count_skipped(keyword);
      }
    } while (text_.next_line(!keyword.starts_with('#')));  // a backslash does not continue a comment
    return build();
  }

 private:
  void read_position() {
    positions_.push_back(read_three("v"));
    if (!is_position(positions_.back())) text_.fail(position_problem(positions_.back()));
    check_vertices(positions_.size(), limits_);
    const auto color = read_color();
    if (color && colors_.empty()) colors_.resize(positions_.size() - 1, kNoColor);
    if (color || !colors_.empty()) colors_.push_back(color.value_or(kNoColor));
  }

  // Reads the numbers after the coordinates: "r g b", or a weight before them, or neither.
  std::optional<Vec3d> read_color() {
    std::array<double, 4> numbers;
    std::size_t count = 0;
    for (; count < numbers.size(); ++count) {
      const auto number = parse_number<double>(text_.word_of_line());
      if (!number) break;
      numbers[count] = *number;
    }
    if (count < 3) return std::nullopt;
    const Vec3d color(numbers[count - 3], numbers[count - 2], numbers[count - 1]);
    const auto in_range = [](double x) { return x >= 0 && x <= 255; };
    if (!in_range(color.x) || !in_range(color.y) || !in_range(color.z)) return std::nullopt;
    largest_color_ = std::max({largest_color_, color.x, color.y, color.z});
    return color;
  }

  // Returns the index of a material in used_, which it adds if the list lacks it.
  std::int32_t material_index(std::string_view name) {
    if (name.empty()) return -1;
    if (const auto known = material_indices_.find(name); known != material_indices_.end())
      return known->second;
    if (used_.size() == kMaxMaterials)
      text_.fail("file must use at most " + grouped(kMaxMaterials) + " materials");
    const auto index = static_cast<std::int32_t>(used_.size());
    used_.emplace_back(name);
    material_indices_.emplace(name, index);
    return index;
  }

  // Reads three numbers. The caller may read further words.
  Vec3d read_three(const char* what) {
    const double x = read_number(what), y = read_number(what);
    return {x, y, read_number(what)};
  }
  double read_number(const char* what) { return text_.parse_number(text_.word_of_line(), what); }

  std::array<double, 2> read_uv() {
    const double u = read_number("vt");
    const std::string_view v = text_.word_of_line();
    return {u, v.empty() ? 0.0 : text_.parse_number(v, "vt")};
  }

  // Reads "7", "7/2", "7//3" or "7/2/3". Returns the index of the vertex. Corners with the same indices share
  // a vertex.
  std::uint32_t read_corner(std::string_view word) {
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::string_view rest = word; count < 3; ++count) {
      const std::size_t slash = rest.find('/');
      parts[count] = rest.substr(0, slash);
      if (slash == rest.npos) break;
      rest.remove_prefix(slash + 1);
    }
    if (count == 3) text_.fail("corner must be position/uv/normal (got " + excerpt(word) + ")");
    Corner corner;
    corner.position = read_index(parts[0], positions_.size(), "v");
    if (!parts[1].empty() && uvs_.empty())
      ++lost_uvs_;
    else if (!parts[1].empty())
      corner.uv = read_index(parts[1], uvs_.size(), "vt");
    if (!parts[2].empty()) corner.normal = read_index(parts[2], normals_.size(), "vn");

    const std::array<std::uint64_t, 2> words = {corner.position | std::uint64_t{corner.uv} << 32,
                                                corner.normal};
    const std::uint32_t vertex = table_.find_or_add(
        table_.hash(words), corners_.size(), [&](std::uint32_t entry) { return corners_[entry] == corner; });
    if (vertex == corners_.size()) corners_.push_back(corner);
    check_vertices(corners_.size(), limits_);
    return vertex;
  }

  // Reads a positive index, counted from 1, or a negative index, counted from the end of the list: -1 is the
  // last of `count` entries. Returns the index counted from 0.
  std::uint32_t read_index(std::string_view word, std::size_t count, const char* what) const {
    const std::int64_t index = text_.integer_in(word, std::string(what) + " of a corner");
    const auto size = static_cast<std::int64_t>(count);
    const std::string got = " (got " + std::to_string(index) + ")";
    if (size == 0)
      text_.fail(std::string(what) + " of a corner must refer to an earlier " + what + " line" + got);
    if (index == 0 || index > size || index < -size)
      text_.fail(std::string(what) + " of a corner must be from 1 to " + std::to_string(size) +
                 " or -1 to -" + std::to_string(size) + got);
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : size + index);
  }

  void read_face() {
    std::array<std::uint32_t, 3> fan{};
    std::size_t count = 0;
    for (std::string_view word = text_.word_of_line(); !word.empty(); word = text_.word_of_line()) {
      if (word[0] == '#') break;
      const std::uint32_t vertex = read_corner(word);
      fan[std::min<std::size_t>(count, 2)] = vertex;
      if (++count < 3) continue;
      triangles_.push_back(fan);
      check_triangles(triangles_.size(), limits_);
      fan[1] = vertex;
    }
    if (count < 3) text_.fail("face must have at least 3 corners (got " + std::to_string(count) + ")");
    if (count > 3)
      fans_.push_back(
          {static_cast<std::uint32_t>(triangles_.size() - (count - 2)), static_cast<std::uint32_t>(count)});
  }

  void count_skipped(std::string_view keyword) {
    if (keyword == "l") ++lines_;
    if (keyword == "p") ++points_;
    if (keyword == "curv" || keyword == "surf") ++free_forms_;
  }

  void add_notes(TriangleMesh& mesh) const {
    const auto add = [&](std::size_t count, const char* what) {
      if (count > 0) mesh.notes.push_back(grouped(count) + what);
    };
    add(lines_, " lines are not rendered");
    add(points_, " points are not rendered");
    add(free_forms_, " free-form curves and surfaces are not rendered");
    add(lost_uvs_, " texture indices without texture coordinates were ignored");
  }

  MeshModel build() {
    MtlMaterials found;
    if (triangles_.empty()) {  // no material is in use
      used_.clear();
      parts_.clear();
    }
    if (!used_.empty()) found = read_mtl({libraries_.begin(), libraries_.end()}, used_, nearby_);
    for (MeshPart& part : parts_)
      if (part.material >= 0) part.material = found.indices[static_cast<std::size_t>(part.material)];
    TriangleMesh mesh;
    mesh.triangles = std::move(triangles_);
    fill(mesh.positions, positions_, &Corner::position, Vec3d());
    fill(mesh.normals, normals_, &Corner::normal, Vec3d(0, 0, 1));
    fill(mesh.uvs, uvs_, &Corner::uv, std::array<double, 2>{});
    mesh.notes = std::move(found.notes);
    divide_polygons(fans_, mesh);
    fill_colors(mesh);
    add_notes(mesh);
    mesh.parts = std::move(parts_);
    group_parts(mesh);
    set_attributes(mesh);
    if (found.materials.empty()) mesh = whole_of(std::move(mesh));
    return {std::move(mesh), std::move(found.materials), std::move(found.images)};
  }

  // Fills `out` with an attribute of the corners, unless none of them has it.
  template <class T>
  void fill(std::vector<T>& out, const std::vector<T>& values, std::uint32_t Corner::*entry,
            const T& filler) const {
    const auto has = [&](const Corner& corner) { return corner.*entry != Corner::kNone; };
    if (std::none_of(corners_.begin(), corners_.end(), has)) return;
    out.reserve(corners_.size());
    for (const Corner& corner : corners_) {
      checkpoint(out.size());
      out.push_back(has(corner) ? values[corner.*entry] : filler);
    }
  }

  // Colours are sRGB codes, from 0 to 1 or from 0 to 255, as Blender and three.js read them.
  void fill_colors(TriangleMesh& mesh) {
    if (colors_.empty()) return;
    const double scale = largest_color_ > 1 ? 1.0 / 255 : 1.0;
    std::size_t missing = 0;
    for (Vec3d& color : colors_) {
      checkpoint();
      if (color == kNoColor)
        ++missing;
      else
        color = decode_srgb(color * scale);
    }
    mesh.colors.reserve(corners_.size());
    for (const Corner& corner : corners_) {
      const Vec3d& color = colors_[corner.position];
      mesh.colors.push_back(color == kNoColor ? Vec3d(1) : color);
    }
    if (missing > 0)
      mesh.notes.push_back(grouped(missing) + " of " + grouped(colors_.size()) + " vertices have no colour");
  }

  void set_attributes(TriangleMesh& mesh) const {
    set_attribute(
        &MeshPart::has_normals, [&](std::uint32_t i) { return corners_[i].normal != Corner::kNone; }, mesh);
    set_attribute(
        &MeshPart::has_uvs, [&](std::uint32_t i) { return corners_[i].uv != Corner::kNone; }, mesh);
    set_attribute(
        &MeshPart::has_colors,
        [&](std::uint32_t i) { return !colors_.empty() && !(colors_[corners_[i].position] == kNoColor); },
        mesh);
  }

  static constexpr Vec3d kNoColor{-1, -1, -1};

  TextReader text_;
  const MeshLimits& limits_;
  const ReadNearby& nearby_;
  std::vector<Vec3d> positions_, normals_;
  std::vector<Vec3d> colors_;  // by position, as in the file, or kNoColor; empty if no position has one
  double largest_color_ = 0;
  std::vector<std::array<double, 2>> uvs_;
  std::vector<Corner> corners_;  // vertices of the mesh
  IndexTable table_;             // finds equal corners in corners_
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Fan> fans_;          // polygons with more than three corners
  std::vector<MeshPart> parts_;    // materials are indices into used_
  std::vector<std::string> used_;  // names of materials
  std::map<std::string, std::int32_t, std::less<>> material_indices_;  // into used_
  std::set<std::string> libraries_;                                    // texts of the lines "mtllib"
  std::size_t lines_ = 0, points_ = 0, free_forms_ = 0, lost_uvs_ = 0;
};

}  // namespace

MeshModel read_obj(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby) {
  return ObjReader(bytes, limits, nearby).read();
}

}  // namespace orrery
