#include "core/load/radiance_range.h"

#include <algorithm>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxPlanes =
    8;  // limit of OccupiedSpace::planes, with which each untraced ray is compared
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// Multiplies component by component; 0 times infinity is 0.
Vec3d product(const Vec3d& a, const Vec3d& b) {
  const auto times = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
  return {times(a.x, b.x), times(a.y, b.y), times(a.z, b.z)};
}

double distance_to(const Boundsd& box, const Vec3d& p) {
  const Vec3d zero(0);
  return length(largest(zero, largest(box.lo - p, p - box.hi)));
}

// Upper bounds of the incident light from all lights together at one surface point. of_points treats each
// light as one point or direction, of_extents includes the extent of each light.
struct DirectLight {
  Vec3d of_points{0.0}, of_extents{0.0};
};

// Extent of the primitives of one material.
struct MaterialExtent {
  struct Unbounded {
    const ShapeSet* shapes;
    int index;
  };
  Boundsd box;                  // box of the bounded primitives
  std::vector<Unbounded> rest;  // the others
  bool anywhere = false;        // may be at any place

  double distance_to_light(const Vec3d& light) const {
    if (anywhere) return 0;
    double least = box.bounded() ? distance_to(box, light) : kUnlimited;
    for (const auto& [shapes, index] : rest) least = std::min(least, shapes->min_distance(index, light));
    return least;
  }
};

// Returns the extents by material. Materials of instances may be anywhere in the scene, and all materials may
// be anywhere if the scene moves.
std::vector<MaterialExtent> find_extents(const Scene& scene, const SceneFacts& facts, std::size_t materials) {
  std::vector<MaterialExtent> extents(materials);
  if (scene.lights.empty()) return extents;
  std::size_t number = 0;
  for (const auto& shapes : scene.shapes)
    for (int i = 0; i < shapes->size(); ++i, ++number) {
      checkpoint(number);
      MaterialExtent& extent = extents[static_cast<std::size_t>(scene.material_of[number])];
      const Boundsd box = shapes->bounds(i);
      if (box.bounded())
        extent.box.include(box);
      else
        extent.rest.push_back({shapes.get(), i});
    }
  for (; number < scene.material_of.size(); ++number) {
    MaterialExtent& extent = extents[static_cast<std::size_t>(scene.material_of[number])];
    extent.box = facts.bounds;
    extent.anywhere = facts.unbounded || !facts.bounds.bounded();
  }
  for (MaterialExtent& extent : extents) extent.anywhere |= !scene.motion.empty();
  return extents;
}

// Returns bounds for all points of a material.
DirectLight find_direct_light(const Scene& scene, const MaterialExtent& extent) {
  DirectLight found;
  for (const LightPlace& light : scene.lights) {
    const LightSet& set = *scene.light_sets[light.set];
    const LightBounds bounds = set.bounds(light.index);
    const double distance = bounds.parallel ? 0 : extent.distance_to_light(bounds.centre);
    found.of_points = found.of_points + set.max_incident(light.index, distance);
    found.of_extents =
        found.of_extents + set.max_incident(light.index, std::max(0.0, distance - bounds.radius));
  }
  return found;
}

// Returns the maximum radiance of the environment or the background.
Vec3d max_sky_radiance(const Scene& scene) {
  return scene.environment ? scene.environment->most() : scene.background;
}

// Returns the smallest V >= 0 with V = own + albedo V, per channel: 0 if own is 0, otherwise infinity if
// albedo >= 1.
Vec3d interreflected(const Vec3d& own, const Vec3d& albedo) {
  const auto series = [](double of_itself, double share) {
    return of_itself == 0 ? 0 : share < 1 ? of_itself / (1 - share) : kUnlimited;
  };
  return {series(own.x, albedo.x), series(own.y, albedo.y), series(own.z, albedo.z)};
}

// Returns the space of all surfaces. The box is larger than the bounds by a margin for rounding.
OccupiedSpace find_occupied(const Scene& scene, const SceneFacts& facts) {
  constexpr double kMargin = 1e-9;  // times the largest coordinate
  OccupiedSpace found;
  if (!scene.motion.empty() || scene.atmosphere) return found;
  std::size_t unbounded_instances = 0;
  for (const Instance& instance : scene.instances)
    for (const auto& shapes : scene.models[instance.model].shapes)
      for (int i = 0; i < shapes->size(); ++i) unbounded_instances += !shapes->bounds(i).bounded();
  if (unbounded_instances > 0) return found;
  if (facts.unbounded)
    for (const auto& shapes : scene.shapes)
      for (int i = 0; i < shapes->size(); ++i) {
        if (shapes->bounds(i).bounded()) continue;
        const auto plane = shapes->plane(i);
        if (!plane || found.planes.size() == kMaxPlanes) return {};
        found.planes.push_back(*plane);
      }
  found.box = facts.bounds;
  if (!found.box.bounded()) return found;
  const Vec3d margin(kMargin * facts.magnitude.value);
  found.box.lo = found.box.lo - margin;
  found.box.hi = found.box.hi + margin;
  return found;
}

// Returns `most`, but infinity in channels with light that a surface may amplify.
Vec3d amplified(const Vec3d& most, const Vec3d& transmitted) {
  const auto of = [](double light, double share) { return light > 0 && share > 1 ? kUnlimited : light; };
  return {of(most.x, transmitted.x), of(most.y, transmitted.y), of(most.z, transmitted.z)};
}

}  // namespace

// Bounds the radiance that each technique can compute. `own` is the radiance that a surface emits and
// reflects directly from light sources. All other radiance that the surface reflects or refracts is an
// average over other surfaces. The maximum V over all surfaces is therefore at most the maximum of own +
// albedo V.
//
// Ray trees follow only mirror reflection and refraction, which return a fraction R of the light. Ambient and
// direct light of a surface are at most 1 - R times their limits, so V does not exceed the largest sum of
// these limits. Emission is not reduced, so V has no bound if an emitting surface is specular. Surfaces with
// ReflectionLimits::transmitted add this share t of V to their own light, so V is at most own / (1 - t). V
// has no bound if t exceeds 1.
void find_radiance_ranges(const Scene& scene, const std::vector<bool>& used, SceneFacts& facts) {
  facts.occupied = find_occupied(scene, facts);
  if (!scene.atmosphere)
    facts.sky_radiance = {scene.environment ? scene.environment->least() : scene.background,
                          max_sky_radiance(scene)};
  const std::vector<MaterialExtent> extents = find_extents(scene, facts, used.size());
  Vec3d tree = max_sky_radiance(scene), paths = tree;
  for (const LightPlace& place : scene.lights)  // sun discs add to the sky and may overlap
    paths = paths + scene.light_sets[place.set]->max_radiance_at_infinity(place.index);
  Vec3d distributed = paths;
  std::size_t number = 0;
  Vec3d transmitted;
  for (const auto& set : scene.materials)
    for (int i = 0; i < set->size(); ++i, ++number) {
      if (number >= used.size() || !used[number]) continue;
      const ReflectionLimits limits = set->limits(i);
      const DirectLight light = find_direct_light(scene, extents[number]);
      facts.albedo = largest(facts.albedo, limits.albedo);
      const Vec3d ambient = product(limits.ambient, scene.ambient), emission = scene.emission[number];
      const Vec3d shines = interreflected(emission, Vec3d(limits.specular ? 1 : 0));
      const Vec3d seen = shines + ambient + product(limits.light, light.of_points);
      tree = largest(tree, interreflected(seen, limits.transmitted));
      transmitted = largest(transmitted, limits.transmitted);
      const Vec3d own = emission + product(limits.light, light.of_extents);
      paths = largest(paths, interreflected(own, limits.albedo));
      distributed = largest(distributed, interreflected(own + ambient, limits.albedo));
    }
  if (scene.atmosphere) {  // blends radiance with its colour
    const Vec3d color = scene.atmosphere->color();
    tree = largest(tree, color);
    distributed = largest(distributed, color);
    paths = largest(paths, color);
  }
  facts.tree_radiance = {Vec3d(0), amplified(tree, transmitted)};
  facts.distributed_radiance = {Vec3d(0), amplified(distributed, transmitted)};
  facts.path_radiance = {Vec3d(0), amplified(paths, transmitted)};
}

}  // namespace orrery
