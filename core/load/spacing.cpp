#include "core/load/spacing.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/base/task_scope.h"
#include "core/load/mirror_paths.h"
#include "core/load/placed_primitives.h"
#include "core/math/face_normal.h"
#include "core/math/hemisphere.h"
#include "core/model/object_pointer.h"

namespace orrery {
namespace {

// Sample times of a motion: kEvenMoments evenly spaced times, including both ends, and up to kMaxKeyTimes key
// times.
constexpr int kEvenMoments = 9;
constexpr std::size_t kMaxKeyTimes = 16;
// Maximum number of rays per primitive: kManyRays / (number of primitives), but at least kFewestRays.
constexpr std::size_t kManyRays = 1024, kFewestRays = 6;
constexpr std::size_t kMaxTests = 1u << 19;  // maximum ray-primitive tests, over all sample times
constexpr double kCoincident = 1e-13;        // times the largest coordinate; nearer surfaces count as one
constexpr double kBeside = 0.05;             // shift to a neighbouring ray, times the primitive's size
constexpr double kSame = 1e-6;               // relative tolerance of equal distances
// Enlargement of boxes that are tested for overlap, times the size of the smaller box. Rays of pairs also
// start at this distance from the surface.
constexpr double kLayerGap = 1e-3;
constexpr double kParallel = 0.99;  // minimum cosine between the normals of parallel surfaces

// Curved mirrors visible from one curved mirror, as indices into Scene::object_runs. `distance` is the
// distance to the nearest of these mirrors. `radius` is the radius of curvature of the viewing mirror at the
// point from which this distance was measured.
struct VisibleMirrors {
  std::set<std::size_t> others;
  double distance = std::numeric_limits<double>::infinity(), radius = 0;
};

class LayerGapSearch {
 public:
  LayerGapSearch(const Scene& scene, const SceneFacts& facts)
      : scene_(scene),
        magnitude_(std::max(facts.magnitude.value, max_component(abs(scene.placement.eye)))),
        primitives_(scene),
        paths_(scene, primitives_, magnitude_) {}

  SurfaceGaps measure() {
    const std::vector<double> times = moments();
    for (std::size_t i = 0; i < times.size(); ++i) {
      primitives_.place_all(times[i]);
      if (primitives_.complete()) paths_.trace(static_cast<int>(times.size()));
      measure_placed(i > 0, kMaxTests / times.size() * i, kMaxTests / times.size());
    }
    spacing_.turns = paths_.turns();
    return spacing_;
  }

 private:
  std::vector<double> moments() const {
    const auto& [first, last] = scene_.motion;
    if (!(last > first)) return {first};
    std::vector<double> keys;
    const auto add = [&](const std::vector<double>& times) {
      keys.insert(keys.end(), times.begin(), times.end());
    };
    for (const Instance& instance : scene_.instances) add(instance.motion.times);
    for (const auto& set : scene_.shapes) add(set->key_times());
    for (const Model& model : scene_.models)
      for (const auto& set : model.shapes) add(set->key_times());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<double> times;
    const std::size_t step = (keys.size() + kMaxKeyTimes - 1) / kMaxKeyTimes;
    for (std::size_t i = 0; i < keys.size(); i += step) times.push_back(keys[i]);
    for (int i = 0; i < kEvenMoments; ++i) times.push_back(first + (last - first) * i / (kEvenMoments - 1));
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
  }

  // Measures all primitives, or only moving primitives if `moving_alone`. Each round traces one ray toward
  // each primitive, until probe_.tests() exceeds `before` + `tests` / 2. Then pairs with overlapping boxes
  // are measured, until probe_.tests() reaches `before` + `tests`.
  void measure_placed(bool moving_alone, std::size_t before, std::size_t tests) {
    max_tests_ = before + tests / 2;
    std::vector<std::vector<Ray<double>>> rays;
    for (const PlacedPrimitive& placed : primitives_.all())
      rays.push_back(moving_alone && !placed.moves ? std::vector<Ray<double>>() : rays_at(placed));
    mirrors_.assign(scene_.object_runs.size(), {});
    const std::size_t most =
        std::max(kFewestRays, kManyRays / std::max<std::size_t>(1, primitives_.all().size()));
    for (std::size_t round = 0; round < most; ++round) {
      for (std::size_t i = 0; i < primitives_.all().size(); ++i) {
        checkpoint();
        if (rays[i].empty() || probe_.tests() > max_tests_) continue;
        const std::size_t chosen = round * ((rays[i].size() + most - 1) / most);
        if (chosen < rays[i].size())
          look_around(primitives_.all()[i], rays[i][chosen], mirrors_[primitives_.all()[i].object]);
      }
    }
    for (const PlacedPrimitive& placed : primitives_.all()) take_mirror(placed, mirrors_[placed.object]);
    max_tests_ = before + tests;
    measure_pairs(moving_alone);
  }

  // Measures the distance between the surfaces of pairs of primitives. This finds layers that overlap only in
  // part: the first ray passes through the middle of the intersection of both boxes.
  void measure_pairs(bool moving_alone) {
    for (std::size_t i = 0; i < primitives_.all().size(); ++i) {
      checkpoint();
      for (std::size_t k = i + 1; k < primitives_.all().size() && probe_.tests() < max_tests_; ++k)
        if (!moving_alone || primitives_.all()[i].moves || primitives_.all()[k].moves)
          measure_pair(primitives_.all()[i], primitives_.all()[k]);
    }
  }
  void measure_pair(const PlacedPrimitive& one, const PlacedPrimitive& other) {
    if (!one.box.bounded() || !other.box.bounded()) return;
    const double size = std::min(one.box.diagonal(), other.box.diagonal());
    const Vec3d gap = Vec3d(1, 1, 1) * (kLayerGap * size);
    const auto larger = [](const Vec3d& a, const Vec3d& b) {
      return Vec3d(std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z));
    };
    const Vec3d lo = larger(one.box.lo, other.box.lo) - gap, hi = -larger(-one.box.hi, -other.box.hi) + gap;
    if (!(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z)) return;
    const Vec3d middle = (lo + hi) * 0.5, shared = hi - lo;
    const Vec3d along = shared.x <= std::min(shared.y, shared.z) ? Vec3d(1, 0, 0)
                        : shared.y <= shared.z                   ? Vec3d(0, 1, 0)
                                                                 : Vec3d(0, 0, 1);
    const auto first = probe_.intersect(one, {middle - along * size, along});
    if (!first) return;
    // Compares both surfaces from just outside the first one, at three points that are not collinear.
    const Tangents<double> aside = tangents_of(first->outward);
    double distance = 0;
    for (const Vec3d& shift : {Vec3d(), aside.first, aside.second}) {
      const Vec3d from = first->position + shift * (kBeside * size) + first->outward * (kLayerGap * size);
      const auto here = probe_.intersect(one, {from, -first->outward}),
                 there = probe_.intersect(other, {from, -first->outward});
      if (!here || !there || std::abs(dot(here->outward, there->outward)) < kParallel) return;
      distance = std::max(distance, std::abs(here->distance - there->distance));
    }
    if (distance > kCoincident * magnitude_) take_distance(one, distance);
  }
  // Keeps the smaller layer distance. If distances are equal up to rounding, keeps the distance of the object
  // with the lower number.
  void take_distance(const PlacedPrimitive& from, double distance) {
    const double ratio = distance / spacing_.layer_distance.value;
    const int object = scene_.object_runs[from.object].object;
    if (!(ratio < 1 + kSame) || (ratio > 1 - kSame && object >= layer_object_)) return;
    layer_object_ = object;
    spacing_.layer_distance = {distance, pointer_to_object(scene_, from.number)};
  }

  // Returns rays that may hit the primitive. Triangles: rays against the normal, at the middle and near the
  // corners. Unbounded primitives: rays in 26 directions from look_at and from a point near look_at. Other
  // primitives: rays from 26 directions toward the middle of the box.
  std::vector<Ray<double>> rays_at(const PlacedPrimitive& placed) const {
    std::vector<Ray<double>> rays;
    const std::vector<HullTriangle> hull = placed.kernel->hull(placed.index);
    if (hull.size() == 1) {
      const auto& [a, b, c] = hull[0];
      const Vec3d normal = face_normal(a, b, c), middle = (a + b + c) * (1.0 / 3);
      const double away = length(a - middle) + length(b - middle);
      for (const Vec3d& at : {middle, mix(a, middle), mix(b, middle), mix(c, middle)})
        rays.push_back(
            {placed.world_from_model.point(at + normal * away), placed.world_from_model.vector(-normal)});
      return rays;
    }
    const bool bounded = placed.box.bounded();
    add_toward(bounded ? (placed.box.lo + placed.box.hi) * 0.5 : scene_.placement.look_at,
               bounded ? placed.box.diagonal() : 0, rays);
    if (!bounded) add_toward(beside_look_at(), 0, rays);
    return rays;
  }
  // Adds rays from 26 directions toward `middle`. They start `away` metres from `middle`.
  static void add_toward(const Vec3d& middle, double away, std::vector<Ray<double>>& rays) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Vec3d toward = safe_normalize(Vec3d(x, y, z));
          rays.push_back({middle + toward * away, -toward});
        }
  }
  // Returns a point near look_at that is unlikely to be on a line where surfaces intersect.
  Vec3d beside_look_at() const {
    const Vec3d &at = scene_.placement.look_at, back = scene_.placement.eye - at;
    return at + (back + tangents_of(safe_normalize(back)).first * length(back) * 0.5) * 0.25;
  }
  static Vec3d mix(const Vec3d& corner, const Vec3d& middle) { return corner * 0.8 + middle * 0.2; }

  // Measures at three neighbouring points of one primitive and uses the largest distance, because touching
  // spheres are close at a single point only.
  void look_around(const PlacedPrimitive& from, const Ray<double>& ray, VisibleMirrors& seen) {
    const auto first = probe_.intersect(from, ray);
    if (!first) return;
    const double size = from.box.bounded() ? from.box.diagonal() : length(first->position - ray.origin);
    const auto [one, other] = beside(from, *first, size);
    std::array<SurfaceAt, 3> at{*first};
    for (std::size_t i = 1; i < at.size(); ++i) {
      const Vec3d shift = i == 1 ? one : other;
      const auto met = probe_.intersect(from, {ray.origin + shift, ray.direction});
      if (!met) return;
      at[i] = *met;
    }
    take_layer(from, at, 1);
    take_layer(from, at, -1);
    if (primitives_.complete()) look_for_mirrors(from, at, seen);
  }

  // Returns the shifts to two neighbouring points. On a triangle, the shifts follow two sides, so that the
  // points are on the triangle even if it is thin.
  static std::pair<Vec3d, Vec3d> beside(const PlacedPrimitive& placed, const SurfaceAt& at, double size) {
    const std::vector<HullTriangle> hull = placed.kernel->hull(placed.index);
    if (hull.size() == 1) {
      const auto& [a, b, c] = hull[0];
      const Affined& world = placed.world_from_model;
      return {world.vector(b - a) * kBeside, world.vector(c - a) * kBeside};
    }
    const Tangents<double> aside = tangents_of(at.outward);
    return {aside.first * (kBeside * size), aside.second * (kBeside * size)};
  }

  void take_layer(const PlacedPrimitive& from, const std::array<SurfaceAt, 3>& at, double side) {
    double distance = 0;
    for (const SurfaceAt& one : at) distance = std::max(distance, to_next_layer(one, one.outward * side));
    take_distance(from, distance);
  }
  double to_next_layer(const SurfaceAt& at, const Vec3d& along) {
    return nearest(at, along, [&](const PlacedPrimitive&, const SurfaceAt& met) {
      return std::abs(dot(met.outward, at.outward)) >= kParallel;
    });
  }

  void look_for_mirrors(const PlacedPrimitive& from, const std::array<SurfaceAt, 3>& at,
                        VisibleMirrors& seen) {
    const double radius = radius_at(at);
    if (primitives_.mirrored_share(from) == 0 || !(radius < std::numeric_limits<double>::infinity())) return;
    std::optional<std::size_t> other;
    const double distance =
        nearest(at[0], at[0].outward, [&](const PlacedPrimitive& placed, const SurfaceAt& met) {
          if (placed.object == from.object || primitives_.mirrored_share(placed) == 0 ||
              !is_curved(placed, met))
            return false;
          other = placed.object;
          return true;
        });
    if (!other) return;
    seen.others.insert(*other);
    if (distance < seen.distance) seen.distance = distance, seen.radius = radius;
  }
  // Ray errors grow by a factor of 1 + 2 d / r on the way to a mirror at distance d. Each of the other
  // mirrors is hit by a fraction of about (r / (d + r))^2 of the rays that leave a mirror. The growth is
  // multiplied by the mirrored share of the material. It is also multiplied by the square root of the
  // fraction that hits any mirror, because errors are averaged as squares.
  void take_mirror(const PlacedPrimitive& from, const VisibleMirrors& seen) {
    const auto& [others, d, r] = seen;
    if (others.empty()) return;
    const double growth = 1 + 2 * d / r, met = std::sqrt(static_cast<double>(others.size())) * r / (d + r);
    const double counted = primitives_.mirrored_share(from) * growth * std::min(1.0, met);
    if (counted > spacing_.mirrors.growth)
      spacing_.mirrors = {counted, r, pointer_to_object(scene_, from.number)};
  }
  // Estimates the radius of curvature in metres from the curvatures in two directions. For perpendicular
  // directions, the estimate is exact for a cylinder and too small by a factor of sqrt(2) for a sphere.
  static double radius_at(const std::array<SurfaceAt, 3>& at) {
    const auto curvature = [&](const SurfaceAt& neighbour) {
      return length(neighbour.shading - at[0].shading) / length(neighbour.position - at[0].position);
    };
    return 1 / std::hypot(curvature(at[1]), curvature(at[2]));
  }
  bool is_curved(const PlacedPrimitive& placed, const SurfaceAt& at) {
    if (at.shading != at.outward) return true;
    const Tangents<double> aside = tangents_of(at.outward);
    for (const Vec3d& shift : {aside.first, aside.second}) {
      const Vec3d from = at.position + (at.outward + shift) * (kBeside * at.distance);
      const auto neighbour = probe_.intersect(placed, {from, -at.outward});
      if (neighbour && neighbour->outward != at.outward) return true;
    }
    return false;
  }
  // Returns the distance to the nearest primitive along `along` for which is_such(primitive, surface) is
  // true, or infinity.
  template <class IsSuch>
  double nearest(const SurfaceAt& from, const Vec3d& along, const IsSuch& is_such) {
    const double least = kCoincident * magnitude_;
    const Ray<double> ray{from.position + along * least, along};
    const BoxRay<double> box_ray(ray.origin, ray.direction);
    double distance = std::numeric_limits<double>::infinity();
    for (const PlacedPrimitive& other : primitives_.all()) {
      if (!may_meet(other.box, box_ray)) continue;
      const auto met = probe_.intersect(other, ray);
      if (met && met->distance > least && met->distance < distance && is_such(other, *met))
        distance = met->distance;
    }
    return distance;
  }

  const Scene& scene_;
  const double magnitude_;
  PlacedPrimitives primitives_;
  MirrorPaths paths_;
  PrimitiveTester probe_;
  std::vector<VisibleMirrors> mirrors_;  // by object
  int layer_object_ = 0;                 // object of spacing_.layer_distance
  std::size_t max_tests_ = 0;            // limit of probe_.tests() in the current step
  SurfaceGaps spacing_;
};

}  // namespace

SurfaceGaps measure_surface_gaps(const Scene& scene, const SceneFacts& facts) {
  return LayerGapSearch(scene, facts).measure();
}

}  // namespace orrery
