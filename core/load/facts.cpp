#include "core/load/facts.h"

#include <algorithm>

#include "core/base/task_scope.h"
#include "core/lighting/texture_fields.h"
#include "core/load/radiance_range.h"
#include "core/load/spacing.h"
#include "core/model/object_pointer.h"

namespace orrery {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void take_larger(LocatedValue& extreme, double value, const std::string& where) {
  if (value > extreme.value) extreme = {value, where};
}
void take_smaller(LocatedValue& extreme, double value, const std::string& where) {
  if (value < extreme.value) extreme = {value, where};
}

// Replaces `strictest` by `limit` if that is stricter. `where` names the light, material or other feature.
template <class Where>
void take_stricter(RoundingLimit& strictest, const RoundingLimit& limit, const Where& where) {
  if (limit.epsilon < strictest.epsilon) strictest = {limit.epsilon, where() + ": " + limit.reason};
}

// Extents of a list of shape sets, computed in one pass over the primitives.
struct Extents {
  struct Length {
    double value;
    int primitive = 0;
  };
  Boundsd bounded;
  bool has_unbounded = false;
  Length magnitude{0}, smallest{kInfinity};
  std::size_t left_out = 0;
  bool smooth = false;

  explicit Extents(const std::vector<std::unique_ptr<ShapeSet>>& sets) {
    int number = 0;
    for (const auto& shapes : sets) {
      left_out += shapes->left_out();
      smooth |= shapes->traits().smooth;
      for (int i = 0; i < shapes->size(); ++i) add(*shapes, i, number++);
    }
  }

 private:
  void add(const ShapeSet& shapes, int index, int number) {
    checkpoint(static_cast<std::size_t>(index));
    const ShapeSet::SweptBounds reach = shapes.reach(index);
    const bool is_bounded = reach.box.bounded();
    const double coordinate = is_bounded ? reach.box.magnitude() : shapes.anchor_magnitude(index);
    if (coordinate > magnitude.value) magnitude = {coordinate, number};
    has_unbounded = has_unbounded || !is_bounded;
    if (!is_bounded) return;
    bounded.include(reach.box);
    if (reach.min_diagonal < smallest.value) smallest = {reach.min_diagonal, number};
  }
};

// Returns an upper bound of the absolute world coordinates of a point of a model. The bound includes the
// rotation of a moving instance between keys.
double reach_of(const Instance& instance, const Affined& world_from_model, const Vec3d& point) {
  if (instance.motion.times.size() == 1) return max_component(abs(world_from_model.point(point)));
  return max_component(abs(world_from_model.origin)) + length(world_from_model.vector(point));
}

// Adds the extents of instances, in world coordinates and in the model coordinates in which rays are traced.
void add_instances(const Scene& scene, SceneFacts& facts) {
  std::vector<Extents> of_models;
  for (const Model& model : scene.models) {
    of_models.emplace_back(model.shapes);
    facts.left_out += of_models.back().left_out;
    facts.smooth |= of_models.back().smooth;
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Extents& own = of_models[instance.model];
    const std::string where = "/instances/" + std::to_string(i);
    for (const double time : instance.motion.times) {
      const Affined world_from_model = instance.world_from_model(time);
      take_larger(facts.magnitude, own.magnitude.value, where);
      take_smaller(facts.smallest_feature, own.smallest.value / stretch(inverse(world_from_model)), where);
      facts.unbounded = facts.unbounded || own.has_unbounded;
      if (own.has_unbounded)  // the anchor of an unbounded primitive, in world coordinates
        take_larger(
            facts.magnitude,
            max_component(abs(world_from_model.origin)) + stretch(world_from_model) * own.magnitude.value,
            where);
      if (!own.bounded.bounded()) continue;
      for (const Vec3d& corner : corners_of(own.bounded)) {
        take_larger(facts.magnitude, reach_of(instance, world_from_model, corner), where);
        facts.bounds.include(world_from_model.point(corner));
      }
    }
  }
}

void add_atmosphere(const Scene& scene, SceneFacts& facts) {
  if (scene.atmosphere)
    take_stricter(facts.rounding, scene.atmosphere->rounding(), [] { return std::string("/atmosphere"); });
}

void add_lights(const Scene& scene, SceneFacts& facts) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const LightPlace place = scene.lights[i];
    take_stricter(facts.rounding, scene.light_sets[place.set]->rounding(place.index),
                  [&] { return "/lights/" + std::to_string(i); });
  }
}

// Returns the first primitive of each material, or -1 if no primitive uses the material.
std::vector<std::int32_t> find_first_users(const Scene& scene) {
  std::vector<std::int32_t> first_user;
  for (std::size_t p = scene.material_of.size(); p-- > 0;) {
    const auto material = static_cast<std::size_t>(scene.material_of[p]);
    if (material >= first_user.size()) first_user.resize(material + 1, -1);
    first_user[material] = static_cast<std::int32_t>(p);
  }
  return first_user;
}

// Adds the materials that at least one primitive uses.
void add_materials(const Scene& scene, std::span<const std::int32_t> first_user, SceneFacts& facts) {
  std::size_t first = 0;
  for (const auto& set : scene.materials) {
    const MaterialTraits traits = set->traits();
    bool used = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(set->size()); ++i) {
      if (first + i >= first_user.size() || first_user[first + i] < 0) continue;
      used = true;
      facts.materials.emits |= scene.emission[first + i] != Vec3d(0);
      facts.cutouts |= scene.cutouts[first + i].lets_rays_pass();
      const auto user = [&] { return pointer_to_object(scene, first_user[first + i]); };
      const double most = set->max_albedo(static_cast<int>(i));
      if (most > facts.max_albedo.value) facts.max_albedo = {most, user()};
      if (traits.mirrors && most > facts.max_followed_albedo.value)
        facts.max_followed_albedo = {most, user()};
      take_stricter(facts.rounding, set->rounding(static_cast<int>(i)),
                    [&] { return "the material of " + user(); });
    }
    if (used) facts.materials |= traits;
    first += static_cast<std::size_t>(set->size());
  }
}

}  // namespace

SceneFacts gather_facts(const Scene& scene) {
  SceneFacts facts;
  const Extents own(scene.shapes);
  facts.left_out = own.left_out;
  facts.smooth = own.smooth;
  facts.bounds = own.bounded;
  facts.unbounded = own.has_unbounded;
  if (own.magnitude.value > 0)
    facts.magnitude = {own.magnitude.value, pointer_to_object(scene, own.magnitude.primitive)};
  if (own.smallest.value < kInfinity)
    facts.smallest_feature = {own.smallest.value, pointer_to_object(scene, own.smallest.primitive)};
  add_instances(scene, facts);
  add_lights(scene, facts);
  add_atmosphere(scene, facts);
  const std::vector<std::int32_t> first_user = find_first_users(scene);
  add_materials(scene, first_user, facts);
  facts.materials.fields |= texture_fields(scene);
  std::vector<bool> used;
  for (const std::int32_t primitive : first_user) used.push_back(primitive >= 0);
  find_radiance_ranges(scene, used, facts);
  const SurfaceGaps spacing = measure_surface_gaps(scene, facts);
  facts.layer_distance = spacing.layer_distance;
  facts.mirrors = spacing.mirrors;
  facts.turns = spacing.turns;
  return facts;
}

}  // namespace orrery
