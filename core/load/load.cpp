#include "core/load/load.h"

#include <algorithm>
#include <deque>
#include <limits>

#include "core/atmospheres/registry.h"
#include "core/base/hash.h"
#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/cameras/registry.h"
#include "core/environments/registry.h"
#include "core/lights/registry.h"
#include "core/load/cached_assets.h"
#include "core/load/facts.h"
#include "core/load/media.h"
#include "core/materials/registry.h"
#include "core/materials/surface_params.h"
#include "core/params/motion.h"
#include "core/plan/limits.h"
#include "core/plan/options.h"
#include "core/shapes/registry.h"
#include "core/textures/mapping.h"
#include "core/textures/registry.h"

namespace orrery {
namespace {

template <class Types>
std::vector<Choice> choices_of(const Types& types) {
  std::vector<Choice> choices;
  for (const auto& type : types) choices.push_back({type.name, type.summary});
  return choices;
}

// Replaces an up direction along the view: by -z if the view is nearest to the y axis, else by +y.
void replace_up(const Vec3d& view, Scene& scene) {
  const Vec3d size = abs(view);
  const bool is_vertical = size.y >= size.x && size.y >= size.z;
  scene.placement.up = is_vertical ? Vec3d(0, 0, -1) : Vec3d(0, 1, 0);
  scene.notes.push_back({"/camera/up", std::string("is parallel to the view direction and was replaced by ") +
                                           (is_vertical ? "[0, 0, -1]" : "[0, 1, 0]")});
}

void read_camera(Params& p, Scene& scene) {
  const auto type = p.pick("type", "Projection type.", choices_of(camera_types()));
  if (!type) return;
  CameraPlacement& placement = scene.placement;
  placement.eye = p.point("eye", "Position of the camera, in metres.");
  placement.look_at = p.point("look_at", "Point at the centre of the image, in metres.");
  placement.up = p.direction("up", "Direction that is up in the image.", Vec3d(0, 1, 0));
  placement.aperture_radius =
      p.number("aperture_radius", "Radius of the lens in metres, for path and distributed; 0: pinhole.",
               {.min = 0, .max = kMaxLength}, 0.0);
  const double focus =
      p.positive("focus_distance", "Distance to the focal plane, in metres; default: distance to look_at.",
                 derived(1.0));
  if (p.has("focus_distance")) placement.focus_distance = focus;
  placement.blades = {
      static_cast<int>(
          p.integer("aperture_blades", "Number of aperture blades, at least 3; 0: round.", 0, kMaxBlades, 0)),
      p.number("blade_degrees", "Angle of the first aperture corner in degrees, from right toward up.",
               {.min = -360, .max = 360}, 0.0)};
  if (const int blades = placement.blades.count; blades == 1 || blades == 2)
    p.fail("aperture_blades", "must be 0 or at least 3 (got " + std::to_string(blades) + ")");
  scene.camera = camera_types()[*type].read(p);
  if (scene.camera->all_around() && placement.aperture_radius > 0)
    p.fail("aperture_radius", "must be 0 for a panorama, which cannot focus in all directions (got " +
                                  number_text(placement.aperture_radius) + ")");
  for (const auto& [name, value] : scene.camera->parameters())
    if (std::string_view(name) == "fov_degrees") scene.render.fov_degrees = value;
  const Vec3d view = safe_normalize(placement.look_at - placement.eye);
  if (view == Vec3d())
    p.fail("look_at", "must differ from eye");
  else if (!(length(cross(view, placement.up)) > 1e-9))
    replace_up(view, scene);
}

// Reads the objects of a scene or model and records the material of each object.
class ObjectReader {
 public:
  explicit ObjectReader(std::vector<std::unique_ptr<ShapeSet>>& shapes) : shapes_(shapes) {
    for (const auto& type : shape_types()) shapes_.push_back(type.make());
    objects_by_shape_.resize(shapes_.size());
  }

  void read(Params& p, const Names& materials, MeshSource& meshes) {
    checkpoint();
    const auto type = p.pick("type", "Shape type.", choices_of(shape_types()));
    if (!type) return;
    const std::size_t material = p.reference("material", "Name of the material.", materials);
    const int primitives = shapes_[*type]->add(p, meshes);
    objects_by_shape_[*type].push_back({material, primitives, count_++});
  }

  // Calls visit(material name index, primitive count, object) in the order of primitive numbers.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const auto& objects : objects_by_shape_)
      for (const auto& [material, primitives, object] : objects)
        visit(material, static_cast<std::size_t>(primitives), object);
  }

 private:
  struct ObjectOf {
    std::size_t material;
    int primitives;
    std::int32_t object;  // index in the order of reading
  };
  std::int32_t count_ = 0;
  std::vector<std::unique_ptr<ShapeSet>>& shapes_;
  std::vector<std::vector<ObjectOf>> objects_by_shape_;
};

constexpr Range kTurns{.min = -1e6, .max = 1e6};

Vec3d read_scale(Params& p, const Fallback<Vec3d>& fallback) {
  constexpr double kMinScale = 1e-6, kMaxScale = 1e6;
  const auto scale = p.numbers3("scale", "Scale factors along x, y and z; negative factors mirror.",
                                {.min = -kMaxScale, .max = kMaxScale}, fallback);
  for (const double factor : scale)
    if (std::abs(factor) < kMinScale)
      p.fail("scale", "factors must be at least 1e-6 in magnitude (got " + number_text(factor) + ")");
  return {scale[0], scale[1], scale[2]};
}

// Reads the placement at one key. Missing values default to the values of `rest`.
Placement read_key(Params& p, const Placement& rest) {
  Placement key{read_scale(p, derived(rest.scale)),
                p.number("degrees", "Rotation in degrees about the axis of `rotate`; 720 is two turns.",
                         kTurns, derived(rest.degrees)),
                p.point("translate", "Position of the model's origin, in metres.", derived(rest.translate))};
  for (const double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
    if (key.scale.*axis * rest.scale.*axis < 0)
      p.fail("scale", "each factor must have the sign of the factor in the instance's scale, " +
                          number_text(rest.scale.*axis) + " (got " + number_text(key.scale.*axis) + ")");
  return key;
}

Instance read_placement(Params& p, std::size_t model) {
  checkpoint();
  Instance instance{model, Vec3d(0, 1, 0), {}};
  Placement rest;
  rest.scale = read_scale(p, Vec3d(1));
  p.optional_object("rotate", "Rotation about an axis through the origin.", [&](Params& r) {
    instance.axis = r.direction("axis", "Direction of the axis.", Vec3d(0, 1, 0));
    rest.degrees =
        r.number("degrees", "Angle in degrees, anticlockwise as seen from the tip of the axis.", kTurns, 0.0);
  });
  rest.translate = p.point("translate", "Position of the model's origin, in metres.", Vec3d(0));
  instance.motion = read_motion(p, [&](Params& key) { return read_key(key, rest); });
  if (instance.motion.empty()) instance.motion = {{0}, {rest}};
  return instance;
}

class SceneReader {
 public:
  explicit SceneReader(const AssetSource& assets)
      : assets_(assets), scene_(std::make_shared<Scene>()), objects_(scene_->shapes) {
    for (const auto& type : material_types()) scene_->materials.push_back(type.make());
    for (const auto& type : light_types()) scene_->light_sets.push_back(type.make());
  }

  void read(Params& p) {
    p.integer("version", "Version of the scene format.", 1, 1);
    scene_->title = p.text("title", "Title of the scene.", 200, "");
    scene_->description = p.text("description", "Description of the scene.", 200, "");
    p.object("camera", "Camera.", [&](Params& c) { read_camera(c, *scene_); });
    p.optional_object("image", "Image size.",
                      [&](Params& i) { read_scene_options(i, Section::image, scene_->render); });
    scene_->ambient = p.color("ambient", "Ambient light.", Vec3d(0));
    scene_->background = p.color("background", "Radiance of rays that leave the scene.", Vec3d(0));
    p.object_if_given("environment", "Environment light, instead of a background.",
                      [&](Params& e) { read_environment(e); });
    if (p.has("background") && p.has("environment"))
      p.fail("background", "cannot be used with an environment");
    p.object_if_given("atmosphere", "Changes of light on its way to the camera.",
                      [&](Params& a) { read_atmosphere(a); });
    if (scene_->atmosphere && scene_->atmosphere->hides_background())
      for (const char* hidden : {"background", "environment"})
        if (p.has(hidden))
          p.fail(hidden, std::string("cannot be used with ") + scene_->atmosphere->type() +
                             ", whose colour rays that leave the scene receive");
    p.each_named("textures", "Textures by name, which parameters of materials may use.", {0, kMaxTextures},
                 [&](const std::string& name, Params& t) { read_texture(name, t); });
    p.each_named("materials", "Materials by name.", {},
                 [&](const std::string& name, Params& m) { read_material(name, m); });
    p.each("lights", "Light sources.", {0, kMaxLights}, [&](Params& l) { read_light(l); });
    p.each("objects", "Objects, in addition to instances.", {0, kMaxObjects}, [&](Params& o) {
      objects_.read(o, names_, meshes_);
      ++scene_->object_count;
    });
    p.each_named("models", "Models by name: objects that instances place in the scene.", {},
                 [&](const std::string& name, Params& m) { read_model(name, m); });
    std::size_t instanced = 0;
    p.each("instances", "Instances of models.", {0, kMaxObjects}, [&](Params& i) {
      const std::size_t model = i.reference("model", "Name of the model.", model_names_);
      scene_->instances.push_back(read_placement(i, model));
      if (model < scene_->models.size()) instanced += count_primitives(scene_->models[model].shapes);
      ++scene_->object_count;
    });
    if (instanced > kMaxInstanced)
      p.fail("instances", "instances have " + grouped(instanced) + " primitives (limit " +
                              grouped(kMaxInstanced) + ", instanced_primitives)");
    if (scene_->object_count == 0)
      p.fail("objects",
             "scene must have 1 to " + std::to_string(kMaxObjects) + " objects or instances (got 0)");
    p.optional_object("render", "Default render options of requests.",
                      [&](Params& r) { read_scene_options(r, Section::render, scene_->render); });
  }

  // REQUIRES: the whole scene was read without a problem.
  std::shared_ptr<const Scene> finish(const Document& document) {
    scene_->canonical = document.canonical();
    scene_->id = sha256_hex(scene_->canonical);
    number_materials();
    number_objects();
    gather_motion();
    scene_->media = find_media(*scene_);
    for (Problem& note : assets_.take_notes()) scene_->notes.push_back(std::move(note));
    scene_->facts = gather_facts(*scene_);
    const LocatedValue& smallest = scene_->facts.smallest_feature;
    if (smallest.value > 0 && smallest.value < kMinSize)  // moving triangles may have size 0 at some times
      throw InputError(smallest.where, "shapes and triangles must be at least " + number_text(kMinSize) +
                                           " m in size (got " + number_text(smallest.value) + ")");
    return scene_;
  }

 private:
  struct MaterialPlace {
    std::size_t set;
    int index;  // within the set
    std::string name;
    SurfaceParams surface;
    std::vector<TextureUse> uses;  // parameters of the type, without material numbers
  };

  void read_texture(const std::string& name, Params& p) {
    checkpoint();
    const auto type = p.pick("type", "Texture type.", choices_of(texture_types()));
    texture_names_.names.add(name);
    PlacedTexture& placed = scene_->textures.emplace_back();
    texture_names_.bounds.emplace_back();
    if (!type) return;
    placed.name = name;
    placed.type = texture_types()[*type].name;
    placed.texture = texture_types()[*type].read(p, assets_);
    placed.mapping = read_mapping(p);
    placed.vertex_colors =
        p.flag("vertex_colors", "Multiply the texture by the vertex colours of meshes.", false);
    placed.filtered = p.choice("filter", "Average over the pixel, or the value at the centre of the pixel.",
                               {"pixel", "none"}, "pixel") == "pixel";
    if (!placed.texture) return;
    TextureBounds& bounds = texture_names_.bounds.back() = placed.texture->bounds();
    if (!placed.vertex_colors) return;  // colours are from 0 to 1
    const Vec3d& least = bounds.least;
    bounds = {{std::min(least.x, 0.0), std::min(least.y, 0.0), std::min(least.z, 0.0)},
              largest(bounds.most, Vec3d(0))};
  }

  void read_material(const std::string& name, Params& p) {
    checkpoint();
    const auto type = p.pick("type", "Material type.", choices_of(material_types()));
    names_.add(name);
    if (!type) return places_.push_back({0, 0, name, {}, {}});
    MaterialSet& set = *scene_->materials[*type];
    const int index = set.size();
    set.add(p, texture_names_);
    SurfaceParams surface = read_surface_params(p, texture_names_);
    for (const TextureUse& use : surface.uses)
      if (use.slot == kOpacitySlot && !is_plain_uv(use.texture))
        p.fail("opacity", "texture must have the mapping uv and no vertex colours");
    places_.push_back({*type, index, name, std::move(surface), set.texture_uses(index)});
  }

  // Returns whether a texture depends on u and v only. True for unknown textures.
  bool is_plain_uv(int texture) const {
    if (static_cast<std::size_t>(texture) >= scene_->textures.size()) return true;
    const PlacedTexture& placed = scene_->textures[static_cast<std::size_t>(texture)];
    return placed.mapping.kind == TextureMapping::Kind::uv && !placed.vertex_colors;
  }

  void read_environment(Params& p) {
    const auto type = p.pick("type", "Environment type.", choices_of(environment_types()));
    if (!type) return;
    const auto environment = environment_types()[*type].read(p, assets_);
    if (!environment) return;
    if (const auto constant = environment->constant())
      scene_->background = *constant;
    else
      scene_->environment = environment;
  }

  void read_atmosphere(Params& p) {
    const auto type = p.pick("type", "Atmosphere type.", choices_of(atmosphere_types()));
    if (!type) return;
    scene_->atmosphere = atmosphere_types()[*type].read(p);
    if (scene_->atmosphere->hides_background()) scene_->background = scene_->atmosphere->color();
  }

  void read_light(Params& p) {
    const auto type = p.pick("type", "Light type.", choices_of(light_types()));
    if (!type) return;
    LightSet& set = *scene_->light_sets[*type];
    scene_->lights.push_back({*type, set.size()});
    set.add(p);
  }

  void read_model(const std::string& name, Params& p) {
    model_names_.add(name);
    Model& model = scene_->models.emplace_back();
    ObjectReader& objects = model_objects_.emplace_back(model.shapes);
    p.each("objects", "Objects of the model.", {1, kMaxObjects},
           [&](Params& o) { objects.read(o, names_, meshes_); });
  }

  // Numbers the materials set by set and stores the material number of each primitive.
  void number_materials() {
    std::vector<int> first(scene_->materials.size(), 0);
    for (std::size_t set = 1; set < first.size(); ++set)
      first[set] = first[set - 1] + scene_->materials[set - 1]->size();
    scene_->emission.resize(static_cast<std::size_t>(first.back() + scene_->materials.back()->size()));
    scene_->material_names.resize(scene_->emission.size());
    scene_->cutouts.resize(scene_->emission.size());
    for (const auto& [set, index, name, surface, uses] : places_) {
      const auto material = static_cast<std::size_t>(first[set] + index);
      scene_->emission[material] = surface.emission;
      scene_->material_names[material] = name;
      scene_->cutouts[material] = {surface.opacity, surface.alpha_cutoff};
      for (const auto* const list : {&uses, &surface.uses})
        for (TextureUse use : *list) {
          use.material = static_cast<int>(material);
          scene_->texture_uses.push_back(use);
        }
    }
    std::stable_sort(scene_->texture_uses.begin(), scene_->texture_uses.end(),
                     [](const TextureUse& a, const TextureUse& b) { return a.material < b.material; });
    const auto number = [&](const ObjectReader& objects, std::vector<std::int32_t>& into) {
      objects.for_each([&](std::size_t name, std::size_t primitives, std::int32_t) {
        const MaterialPlace place = places_[name];
        into.insert(into.end(), primitives, first[place.set] + place.index);
      });
    };
    auto model = scene_->models.begin();
    for (const ObjectReader& objects : model_objects_) number(objects, (model++)->material_of);
    number(objects_, scene_->material_of);
    for (const Instance& instance : scene_->instances) {
      const auto& of_model = scene_->models[instance.model].material_of;
      scene_->material_of.insert(scene_->material_of.end(), of_model.begin(), of_model.end());
    }
  }

  // Records which primitives belong to which object. A run ends where the next run starts. Objects without
  // primitives have no run.
  void number_objects() {
    std::int32_t primitive = 0, resting = 0;
    const auto add = [&](std::size_t primitives, std::int32_t object) {
      if (primitives > 0) scene_->object_runs.push_back({primitive, object});
      primitive += static_cast<std::int32_t>(primitives);
    };
    objects_.for_each([&](std::size_t, std::size_t primitives, std::int32_t object) {
      add(primitives, object);
      ++resting;
    });
    for (const Instance& instance : scene_->instances)
      add(scene_->models[instance.model].material_of.size(), resting++);
  }

  // Sets scene_->motion to the time span of all animation keys.
  void gather_motion() {
    std::vector<double> times;
    const auto add = [&times](const std::vector<double>& some) {
      if (some.size() > 1) times.insert(times.end(), some.begin(), some.end());
    };
    const auto add_all = [&add](const std::vector<std::unique_ptr<ShapeSet>>& sets) {
      for (const auto& shapes : sets) add(shapes->key_times());
    };
    add_all(scene_->shapes);
    std::vector<bool> seen(scene_->models.size(), false);
    for (const Instance& instance : scene_->instances) {
      add(instance.motion.times);
      if (!seen[instance.model]) add_all(scene_->models[instance.model].shapes);
      seen[instance.model] = true;
    }
    if (times.empty()) return;
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    scene_->motion = {*first, *last};
  }

  const CachedAssetSource assets_;
  MeshSource meshes_{assets_};  // shared by the scene and its models
  std::shared_ptr<Scene> scene_;
  TextureNames texture_names_;
  Names names_{"material"};
  std::vector<MaterialPlace> places_;  // by index of the material name
  ObjectReader objects_;
  Names model_names_{"model"};
  std::deque<ObjectReader> model_objects_;  // in the order of scene_->models
};

}  // namespace

std::shared_ptr<const Scene> load_scene(const Document& document, const AssetSource& assets) {
  SceneReader reader(assets);
  read_document(document, [&](Params& p) { reader.read(p); });
  return reader.finish(document);
}

std::shared_ptr<const Scene> load_scene(std::string_view json, const AssetSource& assets,
                                        const JsonLimits& limits) {
  return load_scene(parse_document(json, limits), assets);
}

std::string scene_schema() {
  const AssetSource none;
  SceneReader reader(none);
  return describe(
      "scene.json", "orrery scene",
      "Scene format of orrery, version 1. Lengths are in metres, angles in degrees, colours linear.",
      [&](Params& p) { reader.read(p); });
}

}  // namespace orrery
