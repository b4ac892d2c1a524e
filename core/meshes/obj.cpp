#include "core/meshes/formats.h"
#include "core/meshes/index_table.h"
#include "core/meshes/polygons.h"
#include "core/meshes/text.h"

// Wavefront OBJ: reads v, vt, vn and f, and skips all other keywords (groups, materials, lines, free-form
// curves). Format: Wavefront, Advanced Visualizer Manual, appendix B1.
namespace orrery {
namespace {

// Indices of a corner into the lists of positions, uvs and normals, counted from 0.
struct Corner {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t position = kNone, uv = kNone, normal = kNone;

  bool operator==(const Corner&) const = default;
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const MeshLimits& limits) : text_(bytes, true), limits_(limits) {}

  TriangleMesh read() {
    std::string_view keyword;
    do {
      keyword = text_.word_of_line();
      if (keyword == "v") {
        positions_.push_back(read_three("v"));
        if (!is_position(positions_.back())) text_.fail(position_problem(positions_.back()));
        check_vertices(positions_.size(), limits_);
      } else if (keyword == "vn") {
        normals_.push_back(read_three("vn"));
      } else if (keyword == "vt") {
        uvs_.push_back(read_uv());
      } else if (keyword == "f") {
        read_face();
      } else {
        count_skipped(keyword);
      }
    } while (text_.next_line(!keyword.starts_with('#')));  // a backslash does not continue a comment
    return build();
  }

 private:
  // Reads three numbers. Further words (a weight, a colour) are ignored.
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
    if (keyword == "usemtl") has_materials_ = true;
    if (keyword == "l") ++lines_;
    if (keyword == "p") ++points_;
    if (keyword == "curv" || keyword == "surf") ++free_forms_;
  }

  void add_notes(TriangleMesh& mesh) const {
    const auto add = [&](std::size_t count, const char* what) {
      if (count > 0) mesh.notes.push_back(grouped(count) + what);
    };
    if (has_materials_) mesh.notes.push_back("materials are not modelled");
    add(lines_, " lines are not rendered");
    add(points_, " points are not rendered");
    add(free_forms_, " free-form curves and surfaces are not rendered");
    add(lost_uvs_, " texture indices without texture coordinates were ignored");
  }

  TriangleMesh build() {
    TriangleMesh mesh;
    mesh.triangles = std::move(triangles_);
    const auto fill = [&](auto& out, const auto& values, std::uint32_t Corner::*entry) {
      for (const Corner& corner : corners_)
        if (corner.*entry == Corner::kNone) return;
      out.reserve(corners_.size());
      for (const Corner& corner : corners_) out.push_back(values[corner.*entry]);
    };
    fill(mesh.positions, positions_, &Corner::position);
    fill(mesh.normals, normals_, &Corner::normal);
    fill(mesh.uvs, uvs_, &Corner::uv);
    divide_polygons(fans_, mesh);
    add_notes(mesh);
    return mesh;
  }

  TextReader text_;
  const MeshLimits& limits_;
  std::vector<Vec3d> positions_, normals_;
  std::vector<std::array<double, 2>> uvs_;
  std::vector<Corner> corners_;  // vertices of the mesh
  IndexTable table_;             // finds equal corners in corners_
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Fan> fans_;  // polygons with more than three corners
  bool has_materials_ = false;
  std::size_t lines_ = 0, points_ = 0, free_forms_ = 0, lost_uvs_ = 0;
};

}  // namespace

MeshModel read_obj(std::string_view bytes, const MeshLimits& limits, const ReadNearby&) {
  return {ObjReader(bytes, limits).read(), {}, {}};
}

}  // namespace orrery
