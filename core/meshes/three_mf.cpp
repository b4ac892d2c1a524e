#include <algorithm>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/mesh_parts.h"
#include "core/meshes/text.h"
#include "core/meshes/three_mf_part.h"
#include "core/meshes/zip_file.h"

// 3D Manufacturing Format (3MF Consortium, Core Specification 1.3): a ZIP archive with the conventions of
// Open Packaging (ECMA-376, part 2) whose model parts are XML documents.
namespace orrery {
namespace {

constexpr std::size_t kMaxPlacedObjects = 250'000;  // a small file can place many objects
constexpr std::size_t kMaxNesting = 64;             // nested components

bool is_model_part(const std::string& name) { return lower_case(name).ends_with(".model"); }

// Archive of a 3MF file. Names of parts ignore case.
class Package {
 public:
  Package(std::string_view bytes, const MeshLimits& limits) : zip_(bytes) {
    // Elements and attributes beyond those of vertices and triangles: transforms, properties, metadata.
    constexpr std::size_t kMore = 1'000'000, kAttributes = 4;
    limits_.elements = limits.vertices + limits.triangles + kMore;
    limits_.attributes = kAttributes * limits_.elements;
    for (const std::string& name : zip_.names()) names_.emplace(lower_case(name), name);
  }

  // Returns the path of the model part with the items to build: the one that the relationships of the package
  // name, or the usual one, or the first one.
  std::string root_part() {
    if (const auto relations = names_.find("_rels/.rels"); relations != names_.end()) {
      const XmlFile file(zip_.read(relations->second), relations->second, {});
      std::string target;
      for_each_element(file.root(), "Relationship", [&](const pugi::xml_node& relation) {
        const bool is_model = XmlFile::text(relation, "Type").value_or("").ends_with("/3dmodel");
        if (is_model && target.empty()) target = file.needed_text(relation, "Target");
      });
      if (!target.empty()) return target;
    }
    if (names_.contains("3d/3dmodel.model")) return "3D/3dmodel.model";
    for (const std::string& name : zip_.names())
      if (is_model_part(name)) return name;
    throw InputError("", "archive must have a model part, such as 3D/3dmodel.model");
  }

  // Returns a key that is equal for all paths of one part.
  static std::string key_of(std::string_view path) {
    return lower_case(path.starts_with('/') ? path.substr(1) : path);
  }

  std::unique_ptr<XmlFile> open(const std::string& key) {
    const auto at = names_.find(key);
    if (at == names_.end())
      throw InputError("", "model part " + excerpt(key, 80) + " is missing in the archive");
    std::string text = zip_.read(at->second);
    if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
    return std::make_unique<XmlFile>(std::move(text), as_utf8(shortened(at->second, 80)), limits_);
  }

 private:
  ZipFile zip_;
  XmlLimits limits_;
  std::map<std::string, std::string> names_;  // names of entries, by lower-case name
};

class PackageReader {
 public:
  PackageReader(std::string_view bytes, const MeshLimits& limits)
      : package_(bytes, limits), limits_(limits) {}

  MeshModel read() {
    const std::string root = Package::key_of(package_.root_part());
    place(root);
    MeshModel model;
    model.unit = part(root).unit;
    if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.positions.size(), Vec3d(1));
    group_parts(mesh_);
    // Vertices without a colour are white, which keeps the colour of a material.
    for (MeshPart& each : mesh_.parts) each.has_colors = each.material < 0 && !mesh_.colors.empty();
    if (contents_.materials.empty()) mesh_.parts.clear();
    for (const auto& [name, count] : contents_.unmodelled)
      mesh_.notes.push_back(grouped(count) + " elements " + name + " are not modelled");
    model.mesh = std::move(mesh_);
    model.materials = std::move(contents_.materials);
    return model;
  }

 private:
  struct Placement {
    std::string part;  // key
    std::uint32_t object;
    std::size_t nesting;
    Affined world_from_object;
  };

  const ThreeMfPart& part(const std::string& key) {
    const auto at = parts_.find(key);
    if (at != parts_.end()) return at->second;
    const std::unique_ptr<XmlFile> file = package_.open(key);
    return parts_.emplace(key, read_three_mf_part(*file, limits_, contents_)).first->second;
  }

  // Places the objects of the items to build depth first, in file order.
  void place(const std::string& root) {
    push(part(root).items, {root, 0, 0, {}});
    while (!stack_.empty()) {
      checkpoint();
      const Placement at = std::move(stack_.back());
      stack_.pop_back();
      const auto& objects = part(at.part).objects;
      const auto object = objects.find(at.object);
      if (object == objects.end())
        throw InputError("", excerpt(at.part, 80) + ": objectid must be the id of an object (got " +
                                 std::to_string(at.object) + ")");
      for (const ThreeMfMesh& mesh : object->second.meshes) add(mesh, at.world_from_object);
      push(object->second.components, at);
    }
  }

  void push(const std::vector<ThreeMfComponent>& components, const Placement& parent) {
    placed_ += components.size();
    if (placed_ > kMaxPlacedObjects)
      throw InputError("", "file must place at most " + grouped(kMaxPlacedObjects) + " objects (got more)");
    if (!components.empty() && parent.nesting == kMaxNesting)
      throw InputError("", "components must nest at most " + grouped(kMaxNesting) + " deep (got object " +
                               std::to_string(parent.object) + " in more, or in itself)");
    for (auto component = components.rbegin(); component != components.rend(); ++component)
      stack_.push_back({component->path.empty() ? parent.part : Package::key_of(component->path),
                        component->object, parent.nesting + 1,
                        compose(parent.world_from_object, component->parent_from_object)});
  }

  void add(const ThreeMfMesh& mesh, const Affined& world_from_object) {
    const std::size_t first_vertex = mesh_.positions.size(), first_triangle = mesh_.triangles.size();
    check_vertices(first_vertex + mesh.positions.size(), limits_);
    check_triangles(first_triangle + mesh.triangles.size(), limits_);
    for (const Vec3d& position : mesh.positions) {
      checkpoint(mesh_.positions.size());
      const Vec3d placed = world_from_object.point(position);
      if (!is_position(placed)) throw InputError("", "placed object: " + position_problem(placed));
      mesh_.positions.push_back(placed);
    }
    if (!mesh.colors.empty()) mesh_.colors.resize(first_vertex, Vec3d(1));
    for (const std::uint32_t color : mesh.colors) mesh_.colors.push_back(contents_.colors[color]);
    for (const MeshPart& each : mesh.parts)
      start_part(first_triangle + each.first_triangle, each.material, mesh_.parts);
    const bool is_mirrored = scaled_determinant(world_from_object) < 0;
    const auto offset = static_cast<std::uint32_t>(first_vertex);
    for (const auto& [a, b, c] : mesh.triangles) {
      checkpoint(mesh_.triangles.size());
      mesh_.triangles.push_back({a + offset, (is_mirrored ? c : b) + offset, (is_mirrored ? b : c) + offset});
    }
  }

  Package package_;
  const MeshLimits& limits_;
  ThreeMfContents contents_;
  std::map<std::string, ThreeMfPart> parts_;  // by key
  std::vector<Placement> stack_;              // objects to place, the next one last
  std::size_t placed_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

bool is_three_mf(std::string_view bytes) {
  if (!ZipFile::is_zip(bytes)) return false;
  const ZipFile zip(bytes);
  return std::any_of(zip.names().begin(), zip.names().end(), is_model_part);
}

MeshModel read_three_mf(std::string_view bytes, const MeshLimits& limits) {
  return PackageReader(bytes, limits).read();
}

}  // namespace orrery
