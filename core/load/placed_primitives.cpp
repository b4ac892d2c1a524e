#include "core/load/placed_primitives.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace orrery {
namespace {

Boundsd box_of(const Boundsd& own, const Affined& world) {
  Boundsd box;
  for (const Vec3d& corner : corners_of(own)) box.include(world.point(corner));
  return box;
}

}  // namespace

std::optional<SurfaceAt> PrimitiveTester::intersect(const PlacedPrimitive& placed, const Ray<double>& ray) {
  static const LaneGroups kOne = LaneGroups::single(0);
  ++tests_;
  const Affined& into = placed.model_from_world;
  rays_.count = 1;
  rays_.set(0, {into.point(ray.origin), into.vector(ray.direction)}, std::numeric_limits<double>::infinity());
  hits_.t[0] = rays_.t_max[0];
  hits_.primitive[0] = kNoPrimitive;
  AcceleratorCounts uncounted;
  placed.kernel->closest(placed.index, rays_, kOne, hits_, uncounted);
  if (hits_.primitive[0] == kNoPrimitive) return std::nullopt;
  placed.kernel->surface(rays_, hits_, kOne, met_);
  const auto to_world = [&](const Vec3d& n) {  // normals transform by the inverse transpose
    return safe_normalize(Vec3d(dot(into.x, n), dot(into.y, n), dot(into.z, n))) * met_.side[0];
  };
  return SurfaceAt{placed.world_from_model.point(met_.position[0]), to_world(met_.geometric[0]),
                   to_world(met_.normal[0]), hits_.t[0]};
}

bool may_meet(const Boundsd& box, const BoxRay<double>& ray) {
  return !box.bounded() || enters(ray, box.lo, box.hi, std::numeric_limits<double>::max());
}

PlacedPrimitives::PlacedPrimitives(const Scene& scene) : scene_(scene) {
  for (const auto& set : scene.materials)
    for (int i = 0; i < set->size(); ++i) shares_.push_back(set->mirrored_share(i));
}

void PlacedPrimitives::place_all(double time) {
  placed_.clear();
  kernels_.clear();
  moved_.clear();
  int number = 0;
  place(scene_.shapes, Affined{}, time, false, number);
  for (const Instance& instance : scene_.instances) {
    const Affined world = instance.world_from_model(time);
    if (scaled_determinant(world) != 0)
      place(scene_.models[instance.model].shapes, world, time, instance.motion.times.size() > 1, number);
  }
}

void PlacedPrimitives::place(const std::vector<std::unique_ptr<ShapeSet>>& sets, const Affined& world,
                             double time, bool moves, int& number) {
  for (const auto& shapes : sets) {
    const int first = std::exchange(number, number + shapes->size());
    const auto count =
        static_cast<int>(std::min(static_cast<std::size_t>(shapes->size()), kMost - placed_.size()));
    const bool whole = count == shapes->size();
    complete_ = complete_ && whole;
    if (count == 0 || (!whole && time > scene_.motion.first)) continue;
    moved_.push_back(shapes->at(time));
    const bool own_motion = moved_.back() != nullptr;
    const ShapeSet& now = own_motion ? *moved_.back() : *shapes;
    ShapeKernelPtr<double>& kernel = own_motion ? kernels_.emplace_back() : resting_[&now];
    if (!kernel) kernel = now.kernel(double(), 0);
    const Affined back = inverse(world);
    for (int i = 0; i < count; ++i) {
      const Boundsd own = now.bounds(i);
      const Boundsd box = own.bounded() ? box_of(own, world) : Boundsd::everything();
      placed_.push_back({moves || own_motion, scene_.object_run_of(first + i), &now, kernel.get(), i,
                         first + i, world, back, box});
    }
  }
}

}  // namespace orrery
