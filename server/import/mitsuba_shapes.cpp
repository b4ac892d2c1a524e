#include <algorithm>
#include <cmath>

#include "core/meshes/text.h"
#include "core/params/params.h"
#include "server/import/mitsuba_scene.h"
#include "server/import/shapes.h"

namespace orrery {
namespace {

// Map of a frame with +z along a segment, whose length it keeps.
Affined along_segment(const Vec3d& from, const Vec3d& to) {
  const Vec3d z = to - from, n = safe_normalize(z);
  const Vec3d x = safe_normalize(cross(std::abs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), n));
  return {x, cross(n, x), n, from};
}

class MitsubaShapeReader {
 public:
  MitsubaShapeReader(MitsubaScene& mitsuba, const MitsubaObject& shape)
      : mitsuba_(mitsuba), scene_(mitsuba.scene), shape_(shape), map_(mitsuba.map_of(shape)) {}

  void read() {
    scene_.at(shape_.place);
    const std::string& type = shape_.type;
    if (type == "shapegroup") return group();
    if (type == "instance") return instance();
    shape_.ignore({"flip_normals"});
    if (type == "rectangle") {
      with_material(true, [&](const std::string& name) {
        add_parallelogram(scene_, map_, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, name);
      });
    } else if (type == "cube") {
      with_material(false, [&](const std::string& name) { add_cube(scene_, map_, name); });
    } else if (type == "sphere") {
      sphere();
    } else if (type == "disk") {
      with_material(true, [&](const std::string& name) { add_disk(scene_, map_, 0, 1, 0, {}, name); });
    } else if (type == "cylinder") {
      cylinder();
    } else if (type == "obj" || type == "ply") {
      mesh_file(type == "obj");
    } else {
      mitsuba_.notes().add("shape " + excerpt(type) + " is left out");
      return;
    }
    if (mitsuba_.document.child(shape_, "medium") != nullptr) mitsuba_.notes().add("medium is left out");
    shape_.note_unused(mitsuba_.notes());
  }

 private:
  // Returns the name of the material with the emission of the shape, or "" if the shape has no surface.
  std::string material(bool is_flat, TextureSide side) {
    const MitsubaObject* const bsdf = mitsuba_.document.child(shape_, "bsdf");
    const MitsubaObject* const emitter = mitsuba_.document.child(shape_, "emitter");
    std::optional<SceneJson> json = SceneJson{{"type", "lambert"}, {"reflectance", 0.5}};
    if (bsdf != nullptr) json = mitsuba_bsdf(mitsuba_, *bsdf, side);
    scene_.at(shape_.place);
    if (emitter != nullptr) {
      if (!json) json = {{"type", "lambert"}, {"reflectance", 0}};
      (*json)["emission"] = emission(*emitter, side);
      if (is_flat) mitsuba_.notes().add("surface that emits on one side emits on both");
    }
    if (!json) return {};
    const std::string wanted = bsdf != nullptr && !bsdf->id.empty() ? bsdf->id
                               : bsdf != nullptr                    ? bsdf->type
                                                                    : "diffuse";
    return scene_.material(wanted, std::move(*json));
  }

  SceneJson emission(const MitsubaObject& emitter, TextureSide side) {
    if (emitter.type != "area")
      mitsuba_.notes().add("emitter " + excerpt(emitter.type) + " of a shape is taken as area");
    emitter.ignore({"sampling_weight"});
    const MitsubaObject* const child = mitsuba_.document.named_child(emitter, "radiance");
    if (child != nullptr && child->tag == "texture")
      return color_json(scene_, mitsuba_texture(mitsuba_, *child, side), 1e6);
    return scene_.color(mitsuba_emission(mitsuba_, emitter, "radiance", Vec3d(1)));
  }

  template <class Add>
  void with_material(bool is_flat, const Add& add) {
    const std::string name = material(is_flat, TextureSide::same_v);
    if (!name.empty()) add(name);
  }

  void sphere() {
    const double radius = shape_.positive("radius", 1);
    map_ = compose(map_, translation(shape_.point("center", {})));
    with_material(
        false, [&](const std::string& name) { add_sphere(scene_, map_, radius, -radius, radius, {}, name); });
  }

  void cylinder() {
    const Vec3d from = shape_.point("p0", {}), to = shape_.point("p1", {0, 0, 1});
    if (from == to) refuse_at(shape_.place, "p0 and p1 of a cylinder must differ");
    const double radius = shape_.positive("radius", 1);
    map_ = compose(map_, along_segment(from, to));
    with_material(true, [&](const std::string& name) {
      add_cylinder(scene_, map_, radius, 0, length(to - from), {}, name);
    });
  }

  // Meshes without normals are smooth unless they have face normals.
  void mesh_file(bool is_obj) {
    const std::string file = shape_.text("filename", ""), name_in_scene = scene_.file_name(file);
    TriangleMesh mesh;
    try {
      mesh = read_mesh(mitsuba_.nearby(file), {}, mitsuba_.nearby);
    } catch (const InputError& error) {
      refuse_at(shape_.place, "mesh " + excerpt(file, 80) + ": " + error.problems().front().detail);
    }
    const bool flips = shape_.flag("flip_tex_coords", is_obj);
    const std::string name = material(true, flips ? TextureSide::flipped_v : TextureSide::same_v);
    if (name.empty()) return;
    const bool has_faces = shape_.flag("face_normals", false);
    if (!instance_parts(map_)) {
      if (has_faces) mesh.normals.clear();
      return add_triangles(scene_, map_, std::move(mesh), false, name);
    }
    SceneJson object{{"type", "mesh"}, {"file", name_in_scene}, {"material", name}};
    if (has_faces && !mesh.normals.empty()) object["crease_degrees"] = 0;
    if (!has_faces && mesh.normals.empty()) object["crease_degrees"] = 180;
    scene_.add_placed(std::move(object), map_);
  }

  void group() {
    if (shape_.id.empty()) refuse_at(shape_.place, "shapegroup must have an id (got none)");
    if (scene_.in_model()) refuse_at(shape_.place, "shapegroup must not be inside another one");
    if (scene_.has_model(shape_.id)) return;
    scene_.begin_model(shape_.id);
    for (const MitsubaObject* const part : mitsuba_.document.children(shape_, "shape")) {
      if (part->type == "instance") refuse_at(part->place, "shapegroup must not contain instances");
      add_mitsuba_shape(mitsuba_, *part);
    }
    scene_.end_model();
  }

  void instance() {
    const MitsubaObject* const of = mitsuba_.document.child(shape_, "shape");
    if (of == nullptr || of->type != "shapegroup")
      refuse_at(shape_.place, "instance must refer to a shapegroup");
    add_mitsuba_shape(mitsuba_, *of);
    scene_.at(shape_.place);
    scene_.add_instance(of->id, map_);
  }

  MitsubaScene& mitsuba_;
  SceneWriter& scene_;
  const MitsubaObject& shape_;
  Affined map_;
};

}  // namespace

void add_mitsuba_shape(MitsubaScene& mitsuba, const MitsubaObject& shape) {
  MitsubaShapeReader(mitsuba, shape).read();
}

}  // namespace orrery
