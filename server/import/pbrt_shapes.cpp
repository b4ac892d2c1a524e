#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/pbrt_scene.h"
#include "server/import/shapes.h"

namespace orrery {
namespace {

constexpr double kShapePi = std::numbers::pi;

// Adds shapes of one directive.
class PbrtShapeReader {
 public:
  PbrtShapeReader(PbrtScene& pbrt, const PbrtShape& shape)
      : pbrt_(pbrt), shape_(shape), p_(shape.parameters) {}

  void read() {
    pbrt_.scene.at(p_.place());
    const std::string& type = shape_.type;
    if (type == "sphere") {
      sphere();
    } else if (type == "disk") {
      disk();
    } else if (type == "cylinder") {
      cylinder();
    } else if (type == "trianglemesh" || type == "loopsubdiv") {
      triangles();
    } else if (type == "bilinearmesh") {
      bilinear();
    } else if (type == "plymesh") {
      ply();
    } else if (type == "curve") {
      p_.ignore({"P", "width", "width0", "width1", "type", "N", "basis", "degree", "splitdepth"});
      pbrt_.notes().add("shape \"curve\" is left out");
    } else {
      refuse_at(p_.place(),
                "type of a shape must be one of pbrt's, such as sphere (got " + excerpt(type) + ")");
    }
    p_.note_unused(pbrt_.notes(), "shape " + excerpt(type));
  }

 private:
  // Returns the name of the material with the attributes of the shape, or "" if the shape has no surface. The
  // area is that of one emitting surface.
  std::string material(double area, bool is_flat) {
    PbrtMaterial& of_shape = shape_.material;
    if (!of_shape.is_converted) {
      of_shape.json = pbrt_material(pbrt_, of_shape.type, of_shape.parameters);
      of_shape.is_converted = true;
      pbrt_.scene.at(p_.place());
    }
    const ImportValue alpha = pbrt_number(pbrt_, p_, "alpha", 1);
    std::optional<SceneJson> json = of_shape.json;
    if (shape_.area_light != nullptr) {
      if (!json) json = {{"type", "lambert"}, {"reflectance", 0}};
      (*json)["emission"] = pbrt_emission(pbrt_, *shape_.area_light, area);
      if (is_flat && !shape_.area_light->flag("twosided", false))
        pbrt_.notes().add("surface that emits on one side emits on both");
    }
    if (!json) return {};
    if (!alpha.is_constant() || alpha.mean().x != 1)
      (*json)["opacity"] = number_json(pbrt_.scene, alpha, 0, 1);
    return pbrt_.scene.material(of_shape.name, std::move(*json));
  }

  Sweep sweep() const {
    const double degrees = p_.number("phimax", 360);
    if (!(degrees > 0 && degrees <= 360))
      refuse_at(p_.place(),
                "phimax must be above 0 and at most 360 degrees (got " + number_text(degrees) + ")");
    return {degrees};
  }

  void sphere() {
    const double radius = p_.positive("radius", 1);
    const double low = p_.number("zmin", -radius), high = p_.number("zmax", radius);
    const Sweep part = sweep();
    const double height = std::min(std::max(low, high), radius) - std::max(std::min(low, high), -radius);
    if (!(height > 0)) refuse_at(p_.place(), "zmin and zmax must enclose a part of the sphere");
    const bool is_whole = height == 2 * radius && part.is_full();
    const std::string name =
        material(part.degrees / 180 * kShapePi * radius * height, !is_whole || shape_.reversed);
    if (!name.empty()) add_sphere(pbrt_.scene, shape_.map, radius, low, high, part, name);
  }

  void disk() {
    const double radius = p_.positive("radius", 1), inner = p_.number("innerradius", 0);
    if (!(inner >= 0 && inner < radius))
      refuse_at(p_.place(),
                "innerradius must be at least 0 and less than radius (got " + number_text(inner) + ")");
    const double height = p_.number("height", 0);
    const Sweep part = sweep();
    const std::string name =
        material(part.degrees / 360 * kShapePi * (radius * radius - inner * inner), true);
    if (!name.empty()) add_disk(pbrt_.scene, shape_.map, height, radius, inner, part, name);
  }

  void cylinder() {
    const double radius = p_.positive("radius", 1);
    const double low = p_.number("zmin", -1), high = p_.number("zmax", 1);
    if (low == high)
      refuse_at(p_.place(), "zmin and zmax of a cylinder must differ (got " + number_text(low) + ")");
    const Sweep part = sweep();
    const std::string name = material(part.degrees / 180 * kShapePi * radius * std::abs(high - low), true);
    if (!name.empty()) add_cylinder(pbrt_.scene, shape_.map, radius, low, high, part, name);
  }

  // Returns indices in groups of `size`, each less than `vertices`.
  std::vector<std::uint32_t> indices(std::size_t size, std::size_t vertices) const {
    std::vector<std::uint32_t> indices;
    const std::vector<double> given = p_.numbers("indices");
    if (given.empty() && vertices == size)
      for (std::uint32_t i = 0; i < size; ++i) indices.push_back(i);
    for (const double index : given) {
      checkpoint();
      if (index != std::floor(index) || index < 0 || index >= static_cast<double>(vertices))
        refuse_at(p_.place(), "index of a vertex must be an integer from 0 to " +
                                  grouped(vertices > 0 ? vertices - 1 : 0) + " (got " + number_text(index) +
                                  ")");
      indices.push_back(static_cast<std::uint32_t>(index));
    }
    if (indices.empty() || indices.size() % size != 0)
      refuse_at(p_.place(), "indices must be in groups of " + std::to_string(size) + " (got " +
                                grouped(indices.size()) + " indices)");
    return indices;
  }

  // Returns values of vertices. Throws unless there is one per vertex, or none.
  template <class V>
  std::vector<V> per_vertex(std::vector<V> values, std::size_t vertices, const char* name) const {
    if (!values.empty() && values.size() != vertices)
      refuse_at(p_.place(), std::string(name) + " must have one value for each of " + grouped(vertices) +
                                " vertices (got " + grouped(values.size()) + ")");
    return values;
  }

  void triangles() {
    TriangleMesh mesh;
    mesh.positions = p_.points("P");
    const std::vector<std::uint32_t> corners = indices(3, mesh.positions.size());
    for (std::size_t i = 0; i < corners.size(); i += 3)
      mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    mesh.normals = per_vertex(p_.points("N"), mesh.positions.size(), "N");
    mesh.uvs =
        per_vertex(p_.find("uv") != nullptr ? p_.pairs("uv") : p_.pairs("st"), mesh.positions.size(), "uv");
    p_.ignore({"S", "faceIndices", "levels"});
    if (shape_.type == "loopsubdiv") pbrt_.notes().add("subdivision surface is drawn as its control mesh");
    add(std::move(mesh));
  }

  // Each triangle is a light of its own, with the power of the directive.
  void add(TriangleMesh mesh) {
    const double area = area_of(mesh, shape_.map) / static_cast<double>(mesh.triangles.size());
    const std::string name = material(area, true);
    if (!name.empty()) add_triangles(pbrt_.scene, shape_.map, std::move(mesh), shape_.reversed, name);
  }

  // Flat patches become two triangles each.
  void bilinear() {
    const std::vector<Vec3d> points = p_.points("P");
    const std::vector<std::uint32_t> corners = indices(4, points.size());
    p_.ignore({"N", "faceIndices"});
    const auto uvs = per_vertex(p_.pairs("uv"), points.size(), "uv");
    TriangleMesh flat;
    std::vector<std::array<Vec3d, 4>> curved;
    for (std::size_t i = 0; i < corners.size(); i += 4) {
      const std::array<Vec3d, 4> at{points[corners[i]], points[corners[i + 1]], points[corners[i + 2]],
                                    points[corners[i + 3]]};
      if (!is_flat(at)) {
        curved.push_back(at);
        continue;
      }
      const auto first = static_cast<std::uint32_t>(flat.positions.size());
      for (std::size_t k = 0; k < 4; ++k) {
        flat.positions.push_back(at[k]);
        flat.uvs.push_back(uvs.empty() ? std::array{k % 2 * 1.0, k / 2 * 1.0} : uvs[corners[i + k]]);
      }
      flat.triangles.push_back({first, first + 1, first + 3});
      flat.triangles.push_back({first, first + 3, first + 2});
    }
    const std::size_t count = corners.size() / 4;
    const std::string name = material(area_of(flat, shape_.map) / static_cast<double>(count), true);
    if (name.empty()) return;
    if (!flat.triangles.empty())
      add_triangles(pbrt_.scene, shape_.map, std::move(flat), shape_.reversed, name);
    for (const std::array<Vec3d, 4>& patch : curved) add_bilinear_patch(pbrt_.scene, shape_.map, patch, name);
  }

  static bool is_flat(const std::array<Vec3d, 4>& at) {
    const Vec3d u = safe_normalize(at[1] - at[0]), v = safe_normalize(at[2] - at[0]);
    return std::abs(dot(cross(u, v), safe_normalize(at[3] - at[0]))) <= 1e-6;
  }

  void ply() {
    const std::string file = p_.text("filename", "");
    p_.ignore({"edgelength"});
    if (file.ends_with(".gz")) {
      pbrt_.notes().add("compressed mesh file (.ply.gz) is left out: decompress it");
      return;
    }
    SceneJson object{{"type", "mesh"}, {"file", pbrt_.scene.file_name(file)}};
    const bool needs_mesh = !instance_parts(shape_.map) ||
                            (shape_.area_light != nullptr && shape_.area_light->find("power") != nullptr);
    if (needs_mesh) return add(read_file(file));
    const std::string name = material(1, true);
    if (name.empty()) return;
    object["material"] = name;
    pbrt_.scene.add_placed(std::move(object), shape_.map);
  }

  TriangleMesh read_file(const std::string& file) {
    try {
      return read_mesh(pbrt_.nearby(file), {}, pbrt_.nearby);
    } catch (const InputError& error) {
      refuse_at(p_.place(), "mesh " + excerpt(file, 80) + ": " + error.problems().front().detail);
    }
  }

  PbrtScene& pbrt_;
  const PbrtShape& shape_;
  const PbrtParameters& p_;
};

}  // namespace

void add_pbrt_shape(PbrtScene& pbrt, const PbrtShape& shape) { PbrtShapeReader(pbrt, shape).read(); }

}  // namespace orrery
