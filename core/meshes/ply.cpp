#include <algorithm>

#include "core/base/task_scope.h"
#include "core/meshes/ply_body.h"
#include "core/meshes/polygons.h"

namespace orrery {
namespace {

// Vertex values that a mesh stores.
enum Slot : std::size_t { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kRed, kGreen, kBlue, kSlots };
struct SlotName {
  std::string_view name;
  Slot slot;
};
constexpr SlotName kSlotNames[] = {{"x", kX},
                                   {"y", kY},
                                   {"z", kZ},
                                   {"nx", kNx},
                                   {"ny", kNy},
                                   {"nz", kNz},
                                   {"u", kU},
                                   {"v", kV},
                                   {"s", kU},
                                   {"t", kV},
                                   {"texture_u", kU},
                                   {"texture_v", kV},
                                   {"red", kRed},
                                   {"green", kGreen},
                                   {"blue", kBlue},
                                   {"r", kRed},
                                   {"g", kGreen},
                                   {"b", kBlue},
                                   {"diffuse_red", kRed},
                                   {"diffuse_green", kGreen},
                                   {"diffuse_blue", kBlue}};

Slot slot_of(const PlyProperty& property) {
  for (const auto& [name, slot] : kSlotNames)
    if (name == property.name && !property.count_type) return slot;
  return kSlots;
}

bool is_polygon(const PlyProperty& property) {
  return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool is_color(const PlyProperty& property) {
  const Slot slot = slot_of(property);
  return slot == kRed || slot == kGreen || slot == kBlue;
}

// Returns the value that stands for a full colour channel. Text files store bytes as any integer type.
double full_channel(PlyType type) {
  if (type == PlyType::float32 || type == PlyType::float64) return 1;
  return type == PlyType::uint16 ? 65535 : 255;
}

template <class Body>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, const MeshLimits& limits)
      : header_(header), limits_(limits), body_(header) {}

  TriangleMesh read() {
    count_vertices();
    for (const PlyElement& element : header_.elements) {
      check_bytes(element);
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) skip_row(element);
    }
    divide_polygons(fans_, mesh_);
    add_notes();
    return std::move(mesh_);
  }

 private:
  void add_notes() {
    if (header_.skipped_lines > 0)
      mesh_.notes.push_back(grouped(header_.skipped_lines) + " header lines without a keyword were skipped");
    for (const PlyElement& element : header_.elements)
      if (element.name == "face" &&
          std::any_of(element.properties.begin(), element.properties.end(), is_color))
        mesh_.notes.push_back("colours of faces are not modelled");
    if (clamped_colors_ > 0)
      mesh_.notes.push_back(grouped(clamped_colors_) +
                            " colours beyond the range of their type were clamped");
  }

  void count_vertices() {
    const auto is_vertex = [](const PlyElement& element) { return element.name == "vertex"; };
    const auto count = std::count_if(header_.elements.begin(), header_.elements.end(), is_vertex);
    if (count != 1)
      body_.fail("file must have exactly one element \"vertex\" (got " + std::to_string(count) + ")");
    vertices_ = std::find_if(header_.elements.begin(), header_.elements.end(), is_vertex)->count;
    check_vertices(vertices_, limits_);
  }

  // Throws InputError if fewer bytes are left than the element needs. Called before memory for the element is
  // allocated.
  void check_bytes(const PlyElement& element) const {
    std::size_t fewest = 0;
    for (const PlyProperty& property : element.properties) {
      fewest += Body::min_bytes(property.count_type.value_or(property.type));
      if (element.name == "face" && is_polygon(property)) fewest += 3 * Body::min_bytes(property.type);
    }
    if (fewest > 0 && element.count > body_.bytes_left() / fewest)
      body_.fail("element " + excerpt(element.name) + " must have " + std::to_string(element.count) +
                 " entries of at least " + std::to_string(fewest) + " bytes (got " +
                 std::to_string(body_.bytes_left()) + " bytes)");
  }

  void read_vertices(const PlyElement& element) {
    std::array<bool, kSlots + 1> has{};
    for (const PlyProperty& property : element.properties) has[slot_of(property)] = true;
    if (!has[kX] || !has[kY] || !has[kZ]) body_.fail("vertex must have the properties x, y and z");
    has_normals_ = has[kNx] && has[kNy] && has[kNz];
    has_uvs_ = has[kU] && has[kV];
    has_colors_ = has[kRed] && has[kGreen] && has[kBlue];
    for (const PlyProperty& property : element.properties)
      if (is_color(property)) full_color_[slot_of(property) - kRed] = full_channel(property.type);
    mesh_.positions.reserve(element.count);
    if (has_normals_) mesh_.normals.reserve(element.count);
    if (has_uvs_) mesh_.uvs.reserve(element.count);
    if (has_colors_) mesh_.colors.reserve(element.count);
    read_rows(element);
    decode_colors();
  }

  void read_rows(const PlyElement& element) {
    const bool lists = std::any_of(element.properties.begin(), element.properties.end(),
                                   [](const PlyProperty& p) { return p.count_type.has_value(); });
    if constexpr (Body::kBinary)
      if (!lists) return read_fixed_rows(element);
    read_any_rows(element);
  }

  // Reads rows of scalar properties: all rows have the same size, and each value has a fixed offset.
  void read_fixed_rows(const PlyElement& element) {
    struct Field {
      Slot slot;
      std::size_t offset;
      PlyLoad load;
    };
    std::vector<Field> fields;
    std::size_t size = 0;
    for (const PlyProperty& property : element.properties) {
      if (slot_of(property) != kSlots)
        fields.push_back({slot_of(property), size, ply_load(property.type, header_.encoding)});
      size += size_of(property.type);
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const char* row = body_.take(size);
      std::array<double, kSlots> values{};
      for (const Field& field : fields) values[field.slot] = field.load(row + field.offset);
      add_vertex(values);
    }
  }

  void read_any_rows(const PlyElement& element) {
    std::vector<Slot> slots;
    for (const PlyProperty& property : element.properties) slots.push_back(slot_of(property));
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::array<double, kSlots> values{};
      for (std::size_t k = 0; k < slots.size(); ++k)
        if (slots[k] == kSlots)
          skip_property(element.properties[k]);
        else
          values[slots[k]] = body_.read(body_.describe(element.properties[k].type));
      add_vertex(values);
    }
  }

  void add_vertex(const std::array<double, kSlots>& values) {
    checkpoint(mesh_.positions.size());
    const Vec3d position(values[kX], values[kY], values[kZ]), normal(values[kNx], values[kNy], values[kNz]);
    const auto number = [&] { return std::to_string(mesh_.positions.size()); };
    if (!is_position(position)) body_.fail(position_problem(position, " for vertex " + number()));
    if (!is_finite(normal) || !std::isfinite(values[kU]) || !std::isfinite(values[kV]))
      body_.fail("normal and texture coordinates of vertex " + number() + " must be finite");
    mesh_.positions.push_back(position);
    if (has_normals_) mesh_.normals.push_back(normal);
    if (has_uvs_) mesh_.uvs.push_back({values[kU], values[kV]});
    if (has_colors_) mesh_.colors.push_back({values[kRed], values[kGreen], values[kBlue]});
  }

  // Colours are sRGB codes, also as floats, which Blender and MeshLab read and write as such. Floats above 1
  // are bytes.
  void decode_colors() {
    std::array<double, 3> full = full_color_;
    for (const Vec3d& color : mesh_.colors)
      for (std::size_t k = 0; k < 3; ++k)
        if (full_color_[k] == 1 && color[k] > 1) full[k] = 255;
    for (Vec3d& color : mesh_.colors) {
      checkpoint();
      bool in_range = true;
      for (std::size_t k = 0; k < 3; ++k) {
        color[k] /= full[k];
        in_range = in_range && color[k] >= 0 && color[k] <= 1;
        color[k] = std::fmin(1, std::fmax(0, color[k]));  // NaN gives 0
      }
      if (!in_range) ++clamped_colors_;
      color = decode_srgb(color);
    }
  }

  void read_faces(const PlyElement& element) {
    const auto polygon = std::find_if(element.properties.begin(), element.properties.end(), is_polygon);
    if (polygon == element.properties.end()) body_.fail("face must have a list property \"vertex_indices\"");
    check_triangles(mesh_.triangles.size() + element.count, limits_);
    mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        if (&property == &*polygon)
          read_polygon(property, i);
        else
          skip_property(property);
      }
  }

  void read_polygon(const PlyProperty& property, std::uint64_t face) {
    const std::uint64_t count = list_length(property);
    if (count < 3)
      body_.fail("face " + std::to_string(face) + " must have at least 3 corners (got " +
                 std::to_string(count) + ")");
    check_triangles(mesh_.triangles.size() + count - 2, limits_);
    const auto value = body_.describe(property.type);
    std::array<std::uint32_t, 3> fan{};
    for (std::uint64_t i = 0; i < count; ++i) {
      checkpoint(face + i);
      const double index = body_.read(value);
      if (!(index >= 0 && index < static_cast<double>(vertices_) && index == std::floor(index)))
        body_.fail("vertex of face " + std::to_string(face) + " must be an integer >= 0 and < " +
                   std::to_string(vertices_) + " (got " + text_of(index) + ")");
      fan[std::min<std::uint64_t>(i, 2)] = static_cast<std::uint32_t>(index);
      if (i < 2) continue;
      mesh_.triangles.push_back(fan);
      fan[1] = fan[2];
    }
    if (count > 3)
      fans_.push_back({static_cast<std::uint32_t>(mesh_.triangles.size() - (count - 2)),
                       static_cast<std::uint32_t>(count)});
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const double count = body_.read(body_.describe(*property.count_type));
    constexpr double kMost = 4294967295.0;  // largest uint32
    if (!(count >= 0 && count <= kMost && count == std::floor(count)))
      body_.fail("list length must be an integer from 0 to 4294967295 (got " + text_of(count) + ")");
    return static_cast<std::uint64_t>(count);
  }
  void skip_list(const PlyProperty& property) {
    const auto value = body_.describe(property.type);
    for (std::uint64_t left = list_length(property); left > 0; --left) {
      checkpoint(left);
      body_.skip(value);
    }
  }
  void skip_property(const PlyProperty& property) {
    if (property.count_type)
      skip_list(property);
    else
      body_.skip(body_.describe(property.type));
  }
  void skip_row(const PlyElement& element) {
    checkpoint();
    for (const PlyProperty& property : element.properties) skip_property(property);
  }

  const PlyHeader& header_;
  const MeshLimits& limits_;
  Body body_;
  std::uint64_t vertices_ = 0;  // vertex count of the header, because faces may precede vertices
  bool has_normals_ = false, has_uvs_ = false, has_colors_ = false;
  std::array<double, 3> full_color_{1, 1, 1};  // value of a full channel
  std::size_t clamped_colors_ = 0;
  TriangleMesh mesh_;
  std::vector<Fan> fans_;  // polygons with more than three corners
};

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const MeshLimits& limits) {
  const PlyHeader header = read_ply_header(bytes);
  return header.encoding == PlyEncoding::ascii ? PlyReader<AsciiPly>(header, limits).read()
                                               : PlyReader<BinaryPly>(header, limits).read();
}

}  // namespace orrery
