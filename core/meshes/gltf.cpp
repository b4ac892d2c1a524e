#include <algorithm>

#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/gltf_animation.h"
#include "core/meshes/gltf_deformation.h"
#include "core/meshes/gltf_file.h"
#include "core/meshes/gltf_materials.h"
#include "core/meshes/gltf_studio.h"
#include "core/meshes/gltf_transform.h"
#include "core/meshes/text.h"

// glTF 2.0 (Khronos, ISO/IEC 12113:2022): sections 3.5 (scenes) and 3.7 (meshes).
namespace orrery {
namespace {

// Maximum number of placed primitives. A small file can place many primitives, because nodes may share a
// mesh.
constexpr std::size_t kMaxPlaced = 250'000;
constexpr const char* kVariants = "KHR_materials_variants";
constexpr std::size_t kMaxNamed = 20;  // extensions that notes name

// Extensions that are supported, except those of materials.
constexpr std::string_view kSupported[] = {"KHR_mesh_quantization",      "EXT_meshopt_compression",
                                           "KHR_draco_mesh_compression", "KHR_lights_punctual",
                                           "EXT_texture_webp",           kVariants};

bool is_supported(std::string_view extension) {
  return std::find(std::begin(kSupported), std::end(kSupported), extension) != std::end(kSupported);
}

// Returns true if the extension does not change geometry.
bool is_harmless(std::string_view extension) {
  constexpr std::string_view kPrefixes[] = {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"};
  return std::any_of(std::begin(kPrefixes), std::end(kPrefixes),
                     [&](std::string_view prefix) { return extension.starts_with(prefix); });
}

class SceneReader {
 public:
  SceneReader(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby,
              const ModelState& state)
      : file_(bytes, nearby), limits_(limits), state_(state) {}

  MeshModel read() {
    if (const auto required = file_.root().find("extensionsRequired"))
      for (std::size_t i = 0; i < required->size(); ++i)
        if (const GltfValue extension = required->item(i);
            !is_supported(extension.text()) && !is_harmless(extension.text()))
          extension.fail("must be an extension that does not change geometry (got " +
                         excerpt(extension.text()) + ")");
    materials_ = read_gltf_materials(file_);
    if (state_.pose) node_poses_ = read_pose(file_, *state_.pose);
    read_variants();
    model_.animations = list_animations(file_);
    place(file_.root().at("nodes"));
    for_each_attribute([&](auto& list, auto filler) {
      if (!list.empty()) list.resize(mesh_.positions.size(), filler);
    });
    add_notes();
    model_.mesh = std::move(mesh_);
    model_.materials = std::move(materials_.materials);
    model_.images = std::move(materials_.images);
    return std::move(model_);
  }

 private:
  // Names the contents that are not modelled.
  void add_notes() {
    mesh_.notes = std::move(materials_.notes);
    if (const std::size_t count = model_.animations.size(); count > 0 && !state_.pose)
      mesh_.notes.push_back(count == 1
                                ? "the model is at rest, without its animation"
                                : "the model is at rest, without its " + grouped(count) + " animations");
    if (without_surface_ > 0)
      mesh_.notes.push_back(grouped(without_surface_) + " primitives of points or lines are not rendered");
    if (const auto used = file_.root().find("extensionsUsed"))
      for (std::size_t i = 0; i < std::min<std::size_t>(used->size(), kMaxNamed); ++i)
        if (const std::string& name = used->item(i).text();
            !is_supported(name) && !is_material_extension(name))
          mesh_.notes.push_back("extension " + excerpt(name) + " is not modelled");
  }

  // Returns the root nodes of the default scene. If the file has no default scene, returns every node that is
  // not a child.
  std::vector<std::size_t> roots(const GltfValue& nodes) const {
    const auto scene = file_.root().find("scene");
    if (!scene) return orphans(nodes);
    std::vector<std::size_t> found;
    const auto listed = file_.root().at("scenes").item(scene->integer()).find("nodes");
    for (std::size_t i = 0; listed && i < listed->size(); ++i) found.push_back(listed->item(i).integer());
    return found;
  }

  // Returns the nodes that are not a child.
  static std::vector<std::size_t> orphans(const GltfValue& nodes) {
    std::vector<std::size_t> found;
    std::vector<bool> is_child(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for_children(nodes.item(i), [&](std::size_t child) {
        if (child < is_child.size()) is_child[child] = true;
      });
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) found.push_back(i);
    return found;
  }

  template <class Visit>
  static void for_children(const GltfValue& node, const Visit& visit) {
    const auto children = node.find("children");
    for (std::size_t i = 0; children && i < children->size(); ++i) visit(children->item(i).integer());
  }

  // Places the meshes of the scene in the order of walk().
  void place(const GltfValue& nodes) {
    world_.resize(nodes.size());
    const std::vector<std::size_t> order = walk(nodes, roots(nodes));
    if (file_.root().find("skins")) {  // joints may be outside the scene
      std::vector<std::size_t> others = orphans(nodes);
      std::erase_if(others, [&](std::size_t node) { return world_[node].has_value(); });
      walk(nodes, others);
    }
    for (const std::size_t index : order) {
      const GltfValue node = nodes.item(index);
      add_gltf_studio(file_.root(), node, *world_[index], model_);
      const auto mesh_index = node.find("mesh");
      if (!mesh_index) continue;
      const GltfValue mesh = file_.root().at("meshes").item(mesh_index->integer());
      const MeshPose pose = pose_of(index, node, mesh);
      const GltfValue primitives = mesh.at("primitives");
      for (std::size_t i = 0; i < primitives.size(); ++i) add_primitive(primitives.item(i), pose);
    }
  }

  // Computes the transforms of the nodes below the roots. Returns the nodes depth first, in file order.
  // Rejects a node that is reached twice, through a cycle or from two parents.
  std::vector<std::size_t> walk(const GltfValue& nodes, const std::vector<std::size_t>& roots) {
    struct Visit {
      std::size_t node;
      Affined world_from_parent;
    };
    std::vector<Visit> stack;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, {}});
    std::vector<std::size_t> order;
    while (!stack.empty()) {
      checkpoint();
      const Visit visit = stack.back();
      stack.pop_back();
      const GltfValue node = nodes.item(visit.node);
      if (world_[visit.node]) node.fail("nodes must form a tree (got this node twice)");
      const Affined world = compose(visit.world_from_parent, transform_of(node, change_of(visit.node)));
      world_[visit.node] = world;
      order.push_back(visit.node);
      const std::size_t first = stack.size();
      for_children(node, [&](std::size_t child) { stack.push_back({child, world}); });
      std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
    }
    return order;
  }

  // Returns the members of a node that the animation changes, or null.
  const NodePose* change_of(std::size_t node) const {
    const auto found = node_poses_.find(node);
    return found == node_poses_.end() ? nullptr : &found->second;
  }

  MeshPose pose_of(std::size_t index, const GltfValue& node, const GltfValue& mesh) {
    MeshPose pose{*world_[index], {}, nullptr};
    auto weights = node.find("weights");
    if (!weights) weights = mesh.find("weights");
    for (std::size_t i = 0; weights && i < weights->size(); ++i)
      pose.weights.push_back(weights->item(i).number());
    if (const NodePose* const change = change_of(index); change && change->weights)
      pose.weights = *change->weights;
    if (const auto skin = node.find("skin")) pose.joints = &joints_of(*skin);
    return pose;
  }

  const JointTransforms& joints_of(const GltfValue& user) {
    const auto known = joints_.find(user.integer());
    if (known != joints_.end()) return known->second;
    const GltfValue skin = file_.root().at("skins").item(user.integer());
    return joints_[user.integer()] = joint_transforms(file_, skin, [&](const GltfValue& joint) {
             if (joint.integer() >= world_.size() || !world_[joint.integer()])
               joint.fail("must be a node below a root (got " + std::to_string(joint.integer()) + ")");
             return *world_[joint.integer()];
           });
  }

  void read_variants() {
    std::vector<std::string>& names = model_.variants;
    if (const auto extension = extension_of(file_.root(), kVariants)) {
      const GltfValue list = extension->at("variants");
      for (std::size_t i = 0; i < list.size(); ++i) names.push_back(list.item(i).at("name").text());
    }
    if (state_.variant.empty()) return;
    const auto named = std::find(names.begin(), names.end(), state_.variant);
    if (named == names.end())
      throw InputError("", "variant must be one of the file, which has " + shortened_names(names) + " (got " +
                               excerpt(state_.variant) + ")");
    variant_ = static_cast<std::uint64_t>(named - names.begin());
  }

  // Returns the material of a primitive in the variant, or nullopt if it has none.
  std::optional<GltfValue> material_of(const GltfValue& primitive) const {
    if (const auto extension = variant_ ? extension_of(primitive, kVariants) : std::nullopt) {
      const GltfValue mappings = extension->at("mappings");
      for (std::size_t i = 0; i < mappings.size(); ++i) {
        const GltfValue variants = mappings.item(i).at("variants");
        for (std::size_t k = 0; k < variants.size(); ++k)
          if (variants.item(k).integer() == *variant_) return mappings.item(i).at("material");
      }
    }
    return primitive.find("material");
  }

  void add_primitive(const GltfValue& primitive, const MeshPose& pose) {
    if (++placed_ > kMaxPlaced)
      primitive.fail("file places more than " + grouped(kMaxPlaced) + " primitives (limit " +
                     grouped(kMaxPlaced) + ")");
    const std::uint64_t mode = integer_or(primitive, "mode", 4);
    if (mode > 6) primitive.fail("mode must be from 0 to 6 (got " + std::to_string(mode) + ")");
    if (mode < 4) {  // points and lines have no surface
      ++without_surface_;
      return;
    }
    file_.decode_primitive(primitive, limits_);
    const GltfValue attributes = primitive.at("attributes");
    const std::size_t first = mesh_.positions.size();
    MeshPart part{static_cast<std::uint32_t>(mesh_.triangles.size())};
    if (const auto material = material_of(primitive)) {
      file_.root().at("materials").item(material->integer());  // throws if there is no such material
      part.material = static_cast<std::int32_t>(material->integer());
    }
    const GltfNumbers positions = file_.accessor(attributes.at("POSITION"), "VEC3");
    check_vertices(mesh_.positions.size() + positions.count, limits_);
    const VertexPlacer placer(file_, primitive, positions.count, pose);
    add_vertices(attributes, positions, placer, part);
    const auto indices = primitive.find("indices");
    std::vector<std::uint32_t> order = indices ? read_indices(*indices, first) : std::vector<std::uint32_t>();
    if (!indices)
      for (std::size_t i = first; i < mesh_.positions.size(); ++i)
        order.push_back(static_cast<std::uint32_t>(i));
    add_triangles(primitive, mode, order, placer.mirrors());
    mesh_.parts.push_back(part);
  }

  template <class Visit>
  void for_each_attribute(const Visit& visit) {
    visit(mesh_.normals, Vec3d(0, 0, 1));
    visit(mesh_.uvs, std::array<double, 2>{});
    visit(mesh_.colors, Vec3d(1));
  }

  // Adds the vertices of a primitive, and records the attributes that they have. Vertices before them that
  // lack an attribute receive a filler.
  void add_vertices(const GltfValue& attributes, const GltfNumbers& positions, const VertexPlacer& placer,
                    MeshPart& part) {
    const std::size_t first = mesh_.positions.size();
    for (std::size_t i = 0; i < positions.count; ++i) {
      checkpoint(i);
      const Vec3d p =
          placer.position(i, {positions.value(i, 0), positions.value(i, 1), positions.value(i, 2)});
      if (!is_position(p)) attributes.fail(position_problem(p, " at vertex " + std::to_string(i)));
      mesh_.positions.push_back(p);
    }
    const auto normals = optional_attribute(attributes, "NORMAL", "VEC3", positions.count);
    part.has_normals = normals.has_value();
    if (normals) mesh_.normals.resize(first, Vec3d(0, 0, 1));
    for (std::size_t i = 0; normals && i < positions.count; ++i) {
      checkpoint(i);
      const Vec3d n(normals->value(i, 0), normals->value(i, 1), normals->value(i, 2));
      const Vec3d turned = placer.normal(i, n);
      if (!is_finite(turned))
        attributes.fail("normals must be finite (got " + text_of(n) + " at vertex " + std::to_string(i) +
                        ")");
      mesh_.normals.push_back(turned);
    }
    const int set = part.material < 0 ? 0 : materials_.uv_sets[static_cast<std::size_t>(part.material)];
    const auto uvs =
        optional_attribute(attributes, ("TEXCOORD_" + std::to_string(set)).c_str(), "VEC2", positions.count);
    part.has_uvs = uvs.has_value();
    if (uvs) mesh_.uvs.resize(first);
    for (std::size_t i = 0; uvs && i < positions.count; ++i) {
      checkpoint(i);
      const double u = uvs->value(i, 0), v = uvs->value(i, 1);
      if (!std::isfinite(u) || !std::isfinite(v))
        attributes.fail("texture coordinates must be finite (got (" + text_of(u) + ", " + text_of(v) +
                        ") at vertex " + std::to_string(i) + ")");
      mesh_.uvs.push_back({u, 1 - v});
    }
    add_colors(attributes, first, part);
  }

  // Adds the colours of the vertices from `first` on. Colours with an alpha lose it.
  void add_colors(const GltfValue& attributes, std::size_t first, MeshPart& part) {
    const auto index = attributes.find("COLOR_0");
    if (!index) return;
    const std::string& type = file_.root().at("accessors").item(index->integer()).at("type").text();
    const std::size_t count = mesh_.positions.size() - first;
    const GltfNumbers colors = file_.attribute(*index, type == "VEC4" ? "VEC4" : "VEC3", count);
    part.has_colors = true;
    mesh_.colors.resize(first, Vec3d(1));
    for (std::size_t i = 0; i < count; ++i) {
      checkpoint(i);
      const Vec3d color(colors.value(i, 0), colors.value(i, 1), colors.value(i, 2));
      const auto in_range = [](double x) { return x >= 0 && x <= 1; };
      if (!in_range(color.x) || !in_range(color.y) || !in_range(color.z))
        index->fail("colours must be from 0 to 1 (got " + text_of(color) + " at vertex " + std::to_string(i) +
                    ")");
      mesh_.colors.push_back(color);
    }
  }

  std::optional<GltfNumbers> optional_attribute(const GltfValue& attributes, const char* name,
                                                const char* type, std::size_t count) {
    const auto index = attributes.find(name);
    return index ? std::optional(file_.attribute(*index, type, count)) : std::nullopt;
  }

  // Returns indices into mesh_.positions. `first` is the index of the primitive's first position.
  std::vector<std::uint32_t> read_indices(const GltfValue& user, std::size_t first) {
    const GltfNumbers numbers = file_.accessor(user, "SCALAR");
    check_triangles(mesh_.triangles.size() + numbers.count / 3, limits_);
    const double count = static_cast<double>(mesh_.positions.size() - first);
    std::vector<std::uint32_t> indices;
    indices.reserve(numbers.count);
    for (std::size_t i = 0; i < numbers.count; ++i) {
      checkpoint(i);
      const double index = numbers.value(i, 0);
      if (!(index >= 0 && index < count && index == std::floor(index)))
        user.fail("indices must be integers >= 0 and < " + std::to_string(mesh_.positions.size() - first) +
                  " (got " + text_of(index) + " at entry " + std::to_string(i) + ")");
      indices.push_back(static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(index));
    }
    return indices;
  }

  void add_triangles(const GltfValue& primitive, std::uint64_t mode, const std::vector<std::uint32_t>& order,
                     bool mirrored) {
    const std::size_t n = order.size();
    if (n < 3 || (mode == 4 && n % 3 != 0))
      primitive.fail("must have at least 3 vertices, and a multiple of 3 in mode 4 (got " +
                     std::to_string(n) + ")");
    const std::size_t count = mode == 4 ? n / 3 : n - 2;
    check_triangles(mesh_.triangles.size() + count, limits_);
    for (std::size_t i = 0; i < count; ++i) {
      checkpoint(i);
      std::array<std::size_t, 3> corners = {3 * i, 3 * i + 1, 3 * i + 2};
      if (mode == 5) corners = {i, i + 1 + i % 2, i + 2 - i % 2};  // strips alternate orientation
      if (mode == 6) corners = {i + 1, i + 2, 0};
      if (mirrored) std::swap(corners[1], corners[2]);
      mesh_.triangles.push_back({order[corners[0]], order[corners[1]], order[corners[2]]});
    }
  }

  GltfFile file_;
  const MeshLimits& limits_;
  const ModelState& state_;
  std::optional<std::uint64_t> variant_;  // number in the file
  GltfPose node_poses_;
  TriangleMesh mesh_;
  GltfMaterials materials_;
  MeshModel model_;                                  // cameras and lights
  std::vector<std::optional<Affined>> world_;        // transforms of the nodes, once computed
  std::map<std::uint64_t, JointTransforms> joints_;  // by skin
  std::size_t placed_ = 0, without_surface_ = 0;
};

}  // namespace

MeshModel read_gltf(std::string_view bytes, const MeshLimits& limits, const ReadNearby& nearby,
                    const ModelState& state) {
  return SceneReader(bytes, limits, nearby, state).read();
}

}  // namespace orrery
