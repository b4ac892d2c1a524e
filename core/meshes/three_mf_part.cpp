#include "core/meshes/three_mf_part.h"

#include <algorithm>
#include <charconv>

#include "core/base/number.h"
#include "core/meshes/formats.h"
#include "core/meshes/index_table.h"
#include "core/meshes/mesh_parts.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxPropertyMaterials = 4096;
constexpr std::size_t kMaxUnmodelled = 20;  // names of elements
constexpr std::string_view kUnits[] = {"micron", "millimeter", "centimeter", "inch", "foot", "meter"};

// Group of properties that triangles refer to.
struct PropertyGroup {
  enum class Kind { material, color, other };
  Kind kind = Kind::other;
  std::uint32_t first = 0, count = 0;  // in the lists of ThreeMfContents
};

// Properties of the corners of a triangle.
struct CornerProperties {
  std::int32_t material = -1;
  std::array<std::uint32_t, 3> colors{};  // 0: none
};

// Reference of an element to properties.
struct PropertyReference {
  std::optional<std::uint32_t> group, index;
};

class PartReader {
 public:
  PartReader(const XmlFile& file, const MeshLimits& limits, ThreeMfContents& contents)
      : file_(file), limits_(limits), contents_(contents) {}

  ThreeMfPart read() {
    const pugi::xml_node root = file_.root();
    if (local_name(root.name()) != "model") file_.fail(root, "must be \"model\"");
    part_.unit = XmlFile::text(root, "unit").value_or("millimeter");
    if (std::find(std::begin(kUnits), std::end(kUnits), part_.unit) == std::end(kUnits))
      file_.fail(root, "unit must be micron, millimeter, centimeter, inch, foot or meter (got " +
                           excerpt(part_.unit) + ")");
    for_each_element(root, "resources", [&](const pugi::xml_node& resources) {
      for_each_element(resources, "", [&](const pugi::xml_node& resource) { read_resource(resource); });
    });
    for_each_element(root, "build", [&](const pugi::xml_node& build) {
      for_each_element(build, "item",
                       [&](const pugi::xml_node& item) { part_.items.push_back(read_component(item)); });
    });
    return std::move(part_);
  }

 private:
  void read_resource(const pugi::xml_node& resource) {
    const std::string_view name = local_name(resource.name());
    if (name == "object")
      read_object(resource);
    else if (name == "basematerials")
      read_materials(resource);
    else if (name == "colorgroup")
      read_colors(resource);
    else
      read_other(resource);
  }

  // Notes an element that is not modelled, except metadata. Triangles may refer to it.
  void read_other(const pugi::xml_node& element) {
    note_unmodelled(element);
    if (const auto id = file_.integer(element, "id")) groups_[*id] = {};
  }
  void note_unmodelled(const pugi::xml_node& element) {
    if (local_name(element.name()).starts_with("metadata")) return;
    const std::string name = excerpt(local_name(element.name()));
    if (contents_.unmodelled.size() < kMaxUnmodelled || contents_.unmodelled.contains(name))
      ++contents_.unmodelled[name];
  }

  void read_materials(const pugi::xml_node& element) {
    PropertyGroup group{PropertyGroup::Kind::material,
                        static_cast<std::uint32_t>(contents_.materials.size())};
    for_each_element(element, "base", [&](const pugi::xml_node& base) {
      if (contents_.materials.size() == kMaxPropertyMaterials)
        file_.fail(base,
                   "file must have at most " + grouped(kMaxPropertyMaterials) + " materials (got more)");
      ModelMaterial material;
      material.name = as_utf8(XmlFile::text(base, "name").value_or(""));
      const auto [color, opacity] = color_of(base, "displaycolor");
      material.base_color.factor = color;
      material.opacity = opacity;
      if (opacity < 1) material.alpha = ModelMaterial::Alpha::blend;
      contents_.materials.push_back(std::move(material));
      ++group.count;
    });
    groups_[file_.needed_integer(element, "id")] = group;
  }

  void read_colors(const pugi::xml_node& element) {
    PropertyGroup group{PropertyGroup::Kind::color, static_cast<std::uint32_t>(contents_.colors.size())};
    for_each_element(element, "color", [&](const pugi::xml_node& color) {
      contents_.colors.push_back(color_of(color, "color").first);
      ++group.count;
    });
    groups_[file_.needed_integer(element, "id")] = group;
  }

  // Reads "#RRGGBB" or "#RRGGBBAA" in codes of sRGB. Returns the linear colour and the alpha.
  std::pair<Vec3d, double> color_of(const pugi::xml_node& element, std::string_view name) const {
    const std::string_view text = file_.needed_text(element, name);
    std::uint32_t code = 0;
    const auto [stop, error] = std::from_chars(text.data() + std::min<std::size_t>(1, text.size()),
                                               text.data() + text.size(), code, 16);
    const bool has_alpha = text.size() == 9;
    if (!text.starts_with('#') || (text.size() != 7 && !has_alpha) || error != std::errc() ||
        stop != text.data() + text.size())
      file_.fail(element, std::string(name) + " must be #RRGGBB or #RRGGBBAA (got " + excerpt(text) + ")");
    if (!has_alpha) code = code << 8 | 255;
    const auto channel = [&](int shift) { return (code >> shift & 255) / 255.0; };
    return {decode_srgb(Vec3d(channel(24), channel(16), channel(8))), channel(0)};
  }

  void read_object(const pugi::xml_node& element) {
    const std::uint32_t id = file_.needed_integer(element, "id");
    const auto [at, is_new] = part_.objects.try_emplace(id);
    if (!is_new)
      file_.fail(element, "id must differ from those of other objects (got " + std::to_string(id) + ")");
    ThreeMfObject& object = at->second;
    const PropertyReference fallback{file_.integer(element, "pid"), file_.integer(element, "pindex")};
    for_each_element(element, "", [&](const pugi::xml_node& child) {
      const std::string_view name = local_name(child.name());
      if (name == "mesh") {  // assimp writes several meshes in one object
        ThreeMfMesh mesh;
        read_mesh(child, fallback, mesh);
        if (!mesh.triangles.empty()) object.meshes.push_back(std::move(mesh));
      } else if (name == "components") {
        for_each_element(child, "component", [&](const pugi::xml_node& component) {
          object.components.push_back(read_component(component));
        });
      } else {
        note_unmodelled(child);
      }
    });
  }

  ThreeMfComponent read_component(const pugi::xml_node& element) const {
    return {file_.needed_integer(element, "objectid"),
            std::string(XmlFile::text(element, "path").value_or("")), transform_of(element)};
  }

  // Reads a 4 x 3 matrix in row-major order, which multiplies row vectors from the right.
  Affined transform_of(const pugi::xml_node& element) const {
    const auto text = XmlFile::text(element, "transform");
    if (!text) return {};
    TextReader words(*text);
    std::array<double, 12> m;
    for (double& number : m) {
      const auto read = parse_number<double>(words.word());
      if (!read || !std::isfinite(*read))
        file_.fail(element, "transform must be 12 finite numbers (got " + excerpt(*text, 120) + ")");
      number = *read;
    }
    return {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}, {m[9], m[10], m[11]}};
  }

  void read_mesh(const pugi::xml_node& element, const PropertyReference& fallback, ThreeMfMesh& mesh) {
    std::vector<std::array<std::uint32_t, 3>> colors;  // by triangle; empty if no triangle has one
    for_each_element(element, "", [&](const pugi::xml_node& child) {
      const std::string_view name = local_name(child.name());
      if (name == "vertices")
        for_each_element(child, "vertex", [&](const pugi::xml_node& vertex) { read_vertex(vertex, mesh); });
      else if (name == "triangles")
        for_each_element(child, "triangle", [&](const pugi::xml_node& triangle) {
          const CornerProperties properties = properties_of(triangle, fallback);
          if (properties.colors != std::array<std::uint32_t, 3>{} && colors.empty())
            colors.resize(mesh.triangles.size());
          start_part(mesh.triangles.size(), properties.material, mesh.parts);
          read_triangle(triangle, mesh);
          if (!colors.empty() || properties.colors != std::array<std::uint32_t, 3>{})
            colors.push_back(properties.colors);
        });
      else
        note_unmodelled(child);
    });
    if (!colors.empty()) split_vertices(colors, mesh);
  }

  void read_vertex(const pugi::xml_node& element, ThreeMfMesh& mesh) {
    check_vertices(++contents_.vertices, limits_);
    const Vec3d position(file_.needed_number(element, "x"), file_.needed_number(element, "y"),
                         file_.needed_number(element, "z"));
    if (!is_position(position)) file_.fail(element, position_problem(position));
    mesh.positions.push_back(position);
  }

  void read_triangle(const pugi::xml_node& element, ThreeMfMesh& mesh) {
    check_triangles(++contents_.triangles, limits_);
    auto& triangle = mesh.triangles.emplace_back();
    constexpr std::string_view kCorners[] = {"v1", "v2", "v3"};
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = file_.needed_integer(element, kCorners[k]);
      if (triangle[k] >= mesh.positions.size())
        file_.fail(element, std::string(kCorners[k]) + " must be >= 0 and < " +
                                std::to_string(mesh.positions.size()) + " (got " +
                                std::to_string(triangle[k]) + ")");
    }
  }

  // Returns the properties of a triangle, or those of its mesh.
  CornerProperties properties_of(const pugi::xml_node& triangle, const PropertyReference& fallback) const {
    const auto first = file_.integer(triangle, "p1");
    auto id = fallback.group;
    if (first)
      if (const auto own = file_.integer(triangle, "pid")) id = own;
    const auto index = first ? first : fallback.index;
    if (!id || !index) return {};
    const auto at = groups_.find(*id);
    if (at == groups_.end())
      file_.fail(triangle, "pid must be the id of a group of properties (got " + std::to_string(*id) + ")");
    const PropertyGroup& group = at->second;
    if (group.kind == PropertyGroup::Kind::other) return {};
    const std::array<std::uint32_t, 3> indices{*index, file_.integer(triangle, "p2").value_or(*index),
                                               file_.integer(triangle, "p3").value_or(*index)};
    for (const std::uint32_t i : indices)
      if (i >= group.count)
        file_.fail(triangle, "index of a property must be >= 0 and < " + std::to_string(group.count) +
                                 " (got " + std::to_string(i) + ")");
    if (group.kind == PropertyGroup::Kind::material)
      return {static_cast<std::int32_t>(group.first + indices[0])};
    return {-1, {group.first + indices[0], group.first + indices[1], group.first + indices[2]}};
  }

  // Gives each vertex one colour: adds a vertex for each further colour that triangles use there.
  void split_vertices(const std::vector<std::array<std::uint32_t, 3>>& colors, ThreeMfMesh& mesh) const {
    IndexTable table;
    std::vector<Vec3d> positions;
    std::vector<std::uint64_t> keys;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& vertex = mesh.triangles[t][k];
        const std::uint64_t key = vertex | std::uint64_t{colors[t][k]} << 32;
        const std::uint32_t hash = table.hash(std::span(&key, 1));
        const std::uint32_t entry =
            table.find_or_add(hash, keys.size(), [&](std::uint32_t i) { return keys[i] == key; });
        if (entry == keys.size()) {
          check_vertices(keys.size() + 1, limits_);
          keys.push_back(key);
          positions.push_back(mesh.positions[vertex]);
          mesh.colors.push_back(colors[t][k]);
        }
        vertex = entry;
      }
    mesh.positions = std::move(positions);
  }

  const XmlFile& file_;
  const MeshLimits& limits_;
  ThreeMfContents& contents_;
  ThreeMfPart part_;
  std::map<std::uint32_t, PropertyGroup> groups_;  // by id
};

}  // namespace

ThreeMfPart read_three_mf_part(const XmlFile& file, const MeshLimits& limits, ThreeMfContents& contents) {
  return PartReader(file, limits, contents).read();
}

}  // namespace orrery
