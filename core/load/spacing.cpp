#include "core/load/spacing.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/base/work_scope.h"
#include "core/load/facts.h"
#include "core/math/face_normal.h"
#include "core/math/hemisphere.h"
#include "core/model/batch.h"

namespace orrery {
namespace {

constexpr std::size_t kMostPrimitives = 256;
constexpr int kMoments = 9;  // of a motion at which it is measured, the first and the last among them
constexpr std::size_t kManyRays =
    1024;  // toward all primitives, at all moments; each gets kFewestRays at least
constexpr std::size_t kFewestRays = 6;
constexpr double kCoincident = 1e-13;  // of the largest coordinate: what is as near is one surface
constexpr double kBeside = 0.05;       // of a primitive's size
constexpr double kParallel = 0.99;     // least cosine between the normals of surfaces that run alike

// A primitive where it stands.
struct Placed {
  const ShapeSet* shapes;
  const ShapeKernel<double>* kernel;
  int index, number;  // within the set; within the scene
  Affined world_from_model, model_from_world;
  Boundsd box;  // in the world
};

struct SurfaceAt {
  Vec3d position;
  Vec3d outward;    // unit normal of the primitive
  double distance;  // along the ray, in its lengths
};

// Meets primitives with single rays.
class Probe {
 public:
  std::optional<SurfaceAt> meet(const Placed& placed, const Ray<double>& ray) {
    const Affined& into = placed.model_from_world;
    rays_.count = 1;
    rays_.set(0, {into.point(ray.origin), into.vector(ray.direction)},
              std::numeric_limits<double>::infinity());
    hits_.t[0] = rays_.t_max[0];
    hits_.primitive[0] = kNoPrimitive;
    AcceleratorCounts uncounted;
    placed.kernel->closest(placed.index, rays_, kOne, hits_, uncounted);
    if (hits_.primitive[0] == kNoPrimitive) return std::nullopt;
    placed.kernel->surface(rays_, hits_, kOne, met_);
    const Vec3d n = met_.geometric[0] * met_.side[0];  // to the world by the inverse transposed
    const Vec3d normal(dot(into.x, n), dot(into.y, n), dot(into.z, n));
    return SurfaceAt{placed.world_from_model.point(met_.position[0]), safe_normalize(normal), hits_.t[0]};
  }

 private:
  static inline const Groups kOne = Groups::single(0);
  RayBatch<double> rays_{};
  HitBatch<double> hits_{};
  SurfaceBatch<double> met_{};
};

bool may_meet(const Boundsd& box, const Ray<double>& ray) {
  if (!box.bounded()) return true;
  return enters(BoxRay<double>(ray.origin, ray.direction), box.lo, box.hi,
                std::numeric_limits<double>::max());
}

class Gauge {
 public:
  Gauge(const Scene& scene, const SceneFacts& facts)
      : scene_(scene), magnitude_(std::max(facts.magnitude.value, max_component(abs(scene.placement.eye)))) {
    for (const auto& set : scene.materials)
      for (int i = 0; i < set->size(); ++i) shares_.push_back(set->mirrored_share(i));
  }

  Spacing measure() {
    const auto& [first, last] = scene_.motion;
    const int moments = last > first ? kMoments : 1;
    for (int i = 0; i < moments; ++i) {
      place_all(first + (last - first) * i / std::max(1, moments - 1));
      measure_placed(std::max(kFewestRays, kManyRays / static_cast<std::size_t>(moments) /
                                               std::max<std::size_t>(1, placed_.size())));
    }
    return spacing_;
  }

 private:
  void measure_placed(std::size_t rays_of_each) {
    for (const Placed& placed : placed_) {
      interruption_point();
      mirror_ = {};
      const std::vector<Ray<double>> rays = rays_at(placed);
      const std::size_t step = (rays.size() + rays_of_each - 1) / rays_of_each;
      for (std::size_t i = 0; i < rays.size(); i += step) look_around(placed, rays[i]);
      take_mirror(placed);
    }
  }

  void place_all(double time) {
    placed_.clear();
    kernels_.clear();
    moved_.clear();
    int number = 0;
    place(scene_.shapes, Affined{}, time, number);
    for (const Instance& instance : scene_.instances) {
      const Affined world = instance.world_from_model(time);
      if (scaled_determinant(world) != 0) place(scene_.models[instance.model].shapes, world, time, number);
    }
  }
  void place(const std::vector<std::unique_ptr<ShapeSet>>& sets, const Affined& world, double time,
             int& number) {
    for (const auto& shapes : sets) {
      const int first = std::exchange(number, number + shapes->size());
      const auto count = static_cast<int>(
          std::min(static_cast<std::size_t>(shapes->size()), kMostPrimitives - placed_.size()));
      complete_ = complete_ && count == shapes->size();
      if (count == 0) continue;
      moved_.push_back(shapes->at(time));
      const ShapeSet& now = moved_.back() ? *moved_.back() : *shapes;
      kernels_.push_back(now.kernel(double(), 0));
      const Affined back = inverse(world);
      for (int i = 0; i < count; ++i) {
        const Boundsd own = now.bounds(i);
        const Boundsd box = own.bounded() ? box_of(own, world) : Boundsd::everything();
        placed_.push_back({&now, kernels_.back().get(), i, first + i, world, back, box});
      }
    }
  }
  static Boundsd box_of(const Boundsd& own, const Affined& world) {
    Boundsd box;
    for (const Vec3d& corner : corners_of(own)) box.include(world.point(corner));
    return box;
  }

  // Rays that may meet the primitive: of a triangle at its middle and near its corners, along its normal; of
  // what has no bounds from where the camera looks and from beside it; of others toward the middle of the
  // box.
  std::vector<Ray<double>> rays_at(const Placed& placed) const {
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
  // Rays from `away` metres off `middle` toward it, from all sides.
  static void add_toward(const Vec3d& middle, double away, std::vector<Ray<double>>& rays) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Vec3d toward = safe_normalize(Vec3d(x, y, z));
          rays.push_back({middle + toward * away, -toward});
        }
  }
  // Off the lines on which surfaces that are placed about look_at may cross.
  Vec3d beside_look_at() const {
    const Vec3d &at = scene_.placement.look_at, back = scene_.placement.eye - at;
    return at + (back + tangents_of(safe_normalize(back)).first * length(back) * 0.5) * 0.25;
  }
  static Vec3d mix(const Vec3d& corner, const Vec3d& middle) { return corner * 0.8 + middle * 0.2; }

  // At three points beside each other, for two spheres that touch are near at one point alone.
  void look_around(const Placed& from, const Ray<double>& ray) {
    const auto first = probe_.meet(from, ray);
    if (!first) return;
    const double size = from.box.bounded() ? from.box.diagonal() : length(first->position - ray.origin);
    const Tangents<double> aside = tangents_of(first->outward);
    std::array<SurfaceAt, 3> at{*first};
    for (std::size_t i = 1; i < at.size(); ++i) {
      const Vec3d shift = (i == 1 ? aside.first : aside.second) * (kBeside * size);
      const auto beside = probe_.meet(from, {ray.origin + shift, ray.direction});
      if (!beside) return;
      at[i] = *beside;
    }
    take_layer(from, at, 1);
    take_layer(from, at, -1);
    if (complete_) look_for_mirrors(from, at);
  }

  void take_layer(const Placed& from, const std::array<SurfaceAt, 3>& at, double side) {
    double distance = 0;
    for (const SurfaceAt& one : at) distance = std::max(distance, to_next_layer(one, one.outward * side));
    if (distance < spacing_.layer_distance.value)
      spacing_.layer_distance = {distance, pointer_to_object(scene_, from.number)};
  }
  double to_next_layer(const SurfaceAt& at, const Vec3d& along) {
    return nearest(at, along, [&](const Placed&, const SurfaceAt& met) {
      return std::abs(dot(met.outward, at.outward)) >= kParallel;
    });
  }

  void look_for_mirrors(const Placed& from, const std::array<SurfaceAt, 3>& at) {
    const double radius = radius_at(at);
    if (mirrored_share(from) == 0 || !(radius < std::numeric_limits<double>::infinity())) return;
    int other = -1;
    const double distance = nearest(at[0], at[0].outward, [&](const Placed& placed, const SurfaceAt& met) {
      if (placed.number == from.number || mirrored_share(placed) == 0 || !is_curved(placed, met))
        return false;
      other = placed.number;
      return true;
    });
    if (other < 0) return;
    mirror_.others.insert(other);
    if (distance < mirror_.distance) mirror_.distance = distance, mirror_.radius = radius;
  }
  // The errors of rays to mirrors at distance d grow by 1 + 2 d / r; but of all rays that leave a mirror only
  // the share (r / (d + r))^2, about, meets each of the others, and the mean square is what counts.
  void take_mirror(const Placed& from) {
    const auto& [others, d, r] = mirror_;
    if (others.empty()) return;
    const double growth = 1 + 2 * d / r, met = std::sqrt(static_cast<double>(others.size())) * r / (d + r);
    const double counted = mirrored_share(from) * growth * std::min(1.0, met);
    if (counted > spacing_.mirrors.growth)
      spacing_.mirrors = {counted, r, pointer_to_object(scene_, from.number)};
  }
  // From the curvatures along two directions at right angles: exact for a cylinder, r / sqrt 2 for a sphere.
  static double radius_at(const std::array<SurfaceAt, 3>& at) {
    const auto curvature = [&](const SurfaceAt& beside) {
      return length(beside.outward - at[0].outward) / length(beside.position - at[0].position);
    };
    return 1 / std::hypot(curvature(at[1]), curvature(at[2]));
  }
  bool is_curved(const Placed& placed, const SurfaceAt& at) {
    const Tangents<double> aside = tangents_of(at.outward);
    for (const Vec3d& shift : {aside.first, aside.second}) {
      const Vec3d from = at.position + (at.outward + shift) * (kBeside * at.distance);
      const auto beside = probe_.meet(placed, {from, -at.outward});
      if (beside && beside->outward != at.outward) return true;
    }
    return false;
  }
  double mirrored_share(const Placed& placed) const {
    return shares_[static_cast<std::size_t>(scene_.material_of[static_cast<std::size_t>(placed.number)])];
  }

  // Distance to the nearest primitive along `along` of which is_such(primitive, surface there); none:
  // infinite.
  template <class IsSuch>
  double nearest(const SurfaceAt& from, const Vec3d& along, const IsSuch& is_such) {
    const double least = kCoincident * magnitude_;
    const Ray<double> ray{from.position + along * least, along};
    double distance = std::numeric_limits<double>::infinity();
    for (const Placed& other : placed_) {
      if (!may_meet(other.box, ray)) continue;
      const auto met = probe_.meet(other, ray);
      if (met && met->distance > least && met->distance < distance && is_such(other, *met))
        distance = met->distance;
    }
    return distance;
  }

  const Scene& scene_;
  const double magnitude_;
  std::vector<std::unique_ptr<ShapeSet>> moved_;
  std::vector<ShapeKernelPtr<double>> kernels_;
  std::vector<Placed> placed_;
  bool complete_ = true;        // nothing was left out: else it is unknown which mirrors see each other
  std::vector<double> shares_;  // mirrored, of each material
  Probe probe_;
  struct {
    std::set<int> others;                                                   // curved mirrors that it sees
    double distance = std::numeric_limits<double>::infinity(), radius = 0;  // of the nearest, and here
  } mirror_;                                                                // of what is looked at
  Spacing spacing_;
};

}  // namespace

Spacing measure_spacing(const Scene& scene, const SceneFacts& facts) { return Gauge(scene, facts).measure(); }

}  // namespace orrery
