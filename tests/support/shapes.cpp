#include "tests/support/shapes.h"

#include <map>

#include "core/shapes/registry.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

const std::map<std::string, std::vector<Json>>& all_samples() {
  static const std::map<std::string, std::vector<Json>> samples = [] {
    std::map<std::string, std::vector<Json>> map;
    const auto add = [&](const char* text) {
      const Json object = json(text);
      map[object["type"]].push_back(object);
    };
    add("{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}");
    add("{'type': 'sphere', 'center': [0.25, -0.5, 0.125], 'radius': 0.75}");
    add("{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}");
    add("{'type': 'plane', 'point': [0.5, 0.25, 0], 'normal': [1, 2, -3]}");
    add("{'type': 'triangle', 'vertices': [[-1, -0.5, 0], [1, -0.75, 0.25], [0.125, 1, -0.5]]}");
    add("{'type': 'triangle', 'vertices': [[-1, 0, 0], [1, 0.0625, 0], [0, 0, 0]]}");
    add("{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, 1], 'radius': 1}");
    add("{'type': 'disk', 'center': [0.25, 0, -0.5], 'normal': [-2, 1, 2], 'radius': 0.5}");
    add("{'type': 'rectangle', 'corner': [-1, -0.5, 0], 'edge_u': [2, 0, 0], 'edge_v': [0, 1.5, 0]}");
    add("{'type': 'rectangle', 'corner': [0.5, 0.25, -0.5], 'edge_u': [-1, 0.5, 0], 'edge_v': [0.25, 0.5, "
        "0.75]}");
    add("{'type': 'box', 'min': [-1, -0.5, -0.75], 'max': [0.5, 1, 0.25]}");
    add("{'type': 'box', 'min': [-1, -1, -0.0625], 'max': [1, 1, 0.0625]}");
    add("{'type': 'cylinder', 'base': [0, -0.5, 0], 'top': [0, 0.5, 0], 'radius': 0.75}");
    add("{'type': 'cylinder', 'base': [-0.5, -0.25, 0], 'top': [0.5, 0.5, 0.75], 'radius': 0.25}");
    add("{'type': 'cylinder', 'point': [0, 0, 0], 'axis': [0, 0, 1], 'radius': 0.5}");
    add("{'type': 'cylinder', 'point': [0.25, 0, 0], 'axis': [1, -2, 2], 'radius': 0.75}");
    add("{'type': 'cone', 'base': [0, -0.5, 0], 'top': [0, 0.75, 0], 'base_radius': 0.75}");
    add("{'type': 'cone', 'base': [-0.5, -0.25, 0], 'top': [0.5, 0.5, 0.75], 'base_radius': 0.125, "
        "'top_radius': 0.5}");
    add("{'type': 'cone', 'base': [0, 0, 0.0625], 'top': [0, 0.0625, 0], 'base_radius': 1, 'top_radius': "
        "0.25}");
    add("{'type': 'torus', 'center': [0, 0, 0], 'axis': [0, 0, 1], 'major_radius': 0.75, 'minor_radius': "
        "0.25}");
    add("{'type': 'torus', 'center': [0.25, 0, -0.125], 'axis': [1, -2, 2], 'major_radius': 0.5, "
        "'minor_radius': 0.4375}");
    add("{'type': 'torus', 'center': [0, 0.125, 0], 'axis': [-1, 1, 0.5], 'major_radius': 0.875, "
        "'minor_radius': 0.0625}");
    add(R"({'type': 'patch', 'points': [
          [-1, 0, -1], [-0.375, 0.25, -1], [0.375, -0.25, -1], [1, 0, -1],
          [-1, 0.25, -0.375], [-0.375, 0.5, -0.375], [0.375, 0.5, -0.375], [1, 0.25, -0.375],
          [-1, -0.25, 0.375], [-0.375, 0.5, 0.375], [0.375, 0.75, 0.375], [1, 0.25, 0.375],
          [-1, 0.125, 1], [-0.375, 0, 1], [0.375, 0.125, 1], [1, -0.25, 1]]})");
    add(R"({'type': 'patch', 'degree_u': 2, 'degree_v': 1, 'weights': [1, 0.75, 1, 0.5, 0.5, 1, 1, 0.75, 1, 1, 1, 1],
            'points': [[0.75, 0, 0], [0.75, 0.75, 0], [0, 0.75, 0], [0.5, 0, 1], [0.5, 0.5, 1], [0, 0.75, 1],
            [-0.75, 0, 0], [-0.75, -0.75, 0], [0, -0.75, 0], [-0.75, 0, 1], [-0.75, -0.75, 1], [0, -0.75, 0.75]]})");
    add(R"({'type': 'nurbs', 'degree_u': 3, 'degree_v': 2, 'knots_u': [0, 0, 0, 0, 1, 2, 2, 2, 2],
            'knots_v': [0, 1, 2, 3, 4, 5, 6], 'points': [
          [-1, 0, -1], [-0.5, 0.25, -1], [0, -0.25, -1], [0.5, 0.25, -1], [1, 0, -1],
          [-1, 0.5, -0.25], [-0.5, 0, -0.25], [0, 0.5, -0.25], [0.5, 0, -0.25], [1, 0.5, -0.25],
          [-1, 0, 0.25], [-0.5, 0.5, 0.25], [0, 0.25, 0.25], [0.5, 0.5, 0.25], [1, 0, 0.25],
          [-1, 0.25, 1], [-0.5, 0, 1], [0, 0.5, 1], [0.5, 0, 1], [1, -0.25, 1]]})");
    add(R"({'type': 'nurbs', 'degree_u': 2, 'degree_v': 2, 'knots_u': [0, 0, 0, 1, 1, 1],
            'knots_v': [0, 0, 0, 1, 1, 1], 'weights': [1, 0.75, 1, 0.75, 0.5, 0.75, 1, 0.75, 1],
            'points': [[1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0, 0, 1], [0, 0, 1],
            [0, 0, 1]]})");
    add(R"({'type': 'mesh', 'positions': [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
            'indices': [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]})");
    return map;
  }();
  return samples;
}

// Returns a target point for rays in or near the object's box, or near the placement if the object is
// unbounded.
Vec3d aim(Random& random, const Boundsd& bounds, const Placement& placement) {
  if (!bounds.bounded()) return placement.offset + random.in_cube(2 * placement.size);
  const Vec3d middle = (bounds.lo + bounds.hi) * 0.5, half = (bounds.hi - bounds.lo) * 0.6;
  return middle + half * random.in_cube(1);
}

Vec3d along_an_axis(Random& random) {
  Vec3d d(0, 0, random.below(2) ? 1 : -1);
  const int turn = random.below(3);
  return turn == 0 ? d : turn == 1 ? Vec3d(d.z, 0, 0) : Vec3d(0, d.z, 0);
}

// Returns a ray through the spot that grazes the surface, at an angle of at least `least`.
Ray<double> grazing(Random& random, const SurfaceSample<double>& spot, double size, double least) {
  const Vec3d along = cross(spot.geometric, random.direction());
  const double tilt = random.magnitude(least, 0.1) * (random.below(2) ? 1 : -1);
  const Vec3d direction = safe_normalize(safe_normalize(along) + spot.geometric * tilt);
  return {spot.position - direction * (size * random.magnitude(0.1, 100)), direction};
}

template <class T>
Ray<T> unit_ray(const Ray<double>& ray) {
  return {Vec3<T>(ray.origin), safe_normalize(Vec3<T>(ray.direction))};
}

const Placement kFloatPlacements[] = {
    {1, Vec3d()}, {0x1p-10, Vec3d()}, {1024, Vec3d()}, {1, Vec3d(96, -32, 64)}, {1, Vec3d(1000, 500, -250)}};
const Placement kDoublePlacements[] = {{1, Vec3d()},
                                       {0x1p-17, Vec3d()},
                                       {0x1p20, Vec3d()},
                                       {1, Vec3d(1000, 500, -250)},
                                       {1, Vec3d(1e6, 1e6, 1e6)},
                                       {0x1p-17, Vec3d(1000, -1000, 0)}};

}  // namespace

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const auto& type : shape_types()) names.push_back(type.name);
  return names;
}

const std::vector<Json>& shape_samples(const std::string& type) { return all_samples().at(type); }

std::span<const Placement> float_placements() { return kFloatPlacements; }
std::span<const Placement> double_placements() { return kDoublePlacements; }

template <class T>
Rays<T> rays_at(const Json& object, const Placement& placement, int count, std::uint64_t seed) {
  const Target<double> target(scene_with(placement.of(object)));
  Boundsd bounds = Boundsd::everything();
  if (target.bounds(0).bounded()) {
    bounds = Boundsd();
    for (int i = 0; i < target.primitive_count(); ++i) bounds.include(target.bounds(i));
  }
  constexpr double kMinTilt = std::is_same_v<T, float> ? 2e-4 : 1e-6;
  Random random(seed);
  Rays<double> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3d at = aim(random, bounds, placement);
    const double distance = placement.size * (i % 4 == 0 ? random.between(0, 1) : random.magnitude(1, 1000));
    const Vec3d direction = i % 8 == 1 ? along_an_axis(random) : random.direction();
    rays.push_back({at - direction * distance, direction});
  }
  const std::vector<Hit<double>> hits = target.closest(rays);
  const std::vector<SurfaceSample<double>> spots = target.surfaces(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].met() && i % 3 == 0) rays[i] = grazing(random, spots[i], placement.size, kMinTilt);
  Rays<T> converted;
  for (const auto& ray : rays) converted.push_back(unit_ray<T>(ray));
  return converted;
}

template Rays<float> rays_at(const Json&, const Placement&, int, std::uint64_t);
template Rays<double> rays_at(const Json&, const Placement&, int, std::uint64_t);

}  // namespace orrery::test
