#include "core/load/radiance_range.h"

namespace orrery {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// Without 0 times infinity.
Vec3d product(const Vec3d& a, const Vec3d& b) {
  const auto times = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
  return {times(a.x, b.x), times(a.y, b.y), times(a.z, b.z)};
}

double distance_to(const Boundsd& box, const Vec3d& p) {
  const Vec3d zero(0);
  return length(largest(zero, largest(box.lo - p, p - box.hi)));
}

// All that light sources may bring to a point at once: taken for points, and as far as they are wide.
struct DirectLight {
  Vec3d of_points{0.0}, of_extents{0.0};
};

// Where something moves or is unbounded, nothing is known of distances.
DirectLight find_direct_light(const Scene& scene, const SceneFacts& facts) {
  const bool anywhere = facts.unbounded || !scene.motion.empty() || !facts.bounds.bounded();
  DirectLight found;
  for (const LightPlace& light : scene.lights) {
    const LightSet& set = *scene.light_sets[light.set];
    const LightBounds bounds = set.bounds(light.index);
    const double distance = anywhere || bounds.parallel ? 0 : distance_to(facts.bounds, bounds.centre);
    found.of_points = found.of_points + set.most_at(light.index, distance);
    found.of_extents = found.of_extents + set.most_at(light.index, std::max(0.0, distance - bounds.radius));
  }
  return found;
}

// Seen by rays that meet nothing.
Vec3d most_beyond(const Scene& scene) {
  return scene.environment ? scene.environment->most() : scene.background;
}

// The least that satisfies V = own + albedo V; nothing grows from nothing.
Vec3d interreflected(const Vec3d& own, const Vec3d& albedo) {
  const auto series = [](double of_itself, double share) {
    return of_itself == 0 ? 0 : share < 1 ? of_itself / (1 - share) : kUnlimited;
  };
  return {series(own.x, albedo.x), series(own.y, albedo.y), series(own.z, albedo.z)};
}

}  // namespace

// What a surface sends out by itself and of light sources is its own; what it mirrors and refracts, or sends
// on of what others send, is an average over their radiance. So a maximum V over all surfaces is at most
// that over surfaces of own + albedo V. Trees send on nothing but what is mirrored and refracted, a share R,
// and then own is at most 1 - R of a limit but for what shines by itself.
void find_radiance_ranges(const Scene& scene, const std::vector<bool>& used, SceneFacts& facts) {
  const DirectLight light = find_direct_light(scene, facts);
  Vec3d tree = most_beyond(scene), paths = tree;
  for (const LightPlace& place : scene.lights)  // suns stand before the sky, and may overlap
    paths = paths + scene.light_sets[place.set]->most_seen(place.index);
  Vec3d distributed = paths;
  std::size_t number = 0;
  for (const auto& set : scene.materials)
    for (int i = 0; i < set->size(); ++i, ++number) {
      if (number >= used.size() || !used[number]) continue;
      const ReflectionLimits limits = set->limits(i);
      facts.albedo = largest(facts.albedo, limits.albedo);
      const Vec3d ambient = product(limits.ambient, scene.ambient), emission = scene.emission[number];
      const Vec3d shines = interreflected(emission, Vec3d(limits.specular ? 1 : 0));
      tree = largest(tree, shines + ambient + product(limits.light, light.of_points));
      const Vec3d own = emission + product(limits.light, light.of_extents);
      paths = largest(paths, interreflected(own, limits.albedo));
      distributed = largest(distributed, interreflected(own + ambient, limits.albedo));
    }
  facts.tree_radiance = {Vec3d(0), tree};
  facts.distributed_radiance = {Vec3d(0), distributed};
  facts.path_radiance = {Vec3d(0), paths};
}

}  // namespace orrery
