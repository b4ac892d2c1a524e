#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "core/load/load.h"
#include "core/model/shape.h"

namespace orrery {

// One object of a scene. Calls its kernel as the stages do.
template <class T>
class OneShape {
 public:
  // `object` is the JSON of one object with the material "m".
  explicit OneShape(const std::string& object)
      : scene_(load_scene(
            R"({"version": 1, "camera": {"type": "perspective", "eye": [0, 0, 4], "look_at": [0, 0, 0]},
                              "materials": {"m": {"type": "rough"}}, "objects": [)" +
            object + "]}")) {
    for (const auto& set : scene_->shapes)
      if (set->size() > 0) kernel_ = set->kernel(T(), 0);
  }

  // Intersects the rays with the object and fills surface() with the hits. REQUIRES: 1 to kBatch rays, and
  // all hit the object.
  void meet(std::span<const Ray<T>> rays) {
    batch_->count = static_cast<int>(rays.size());
    for (int i = 0; i < kBatchRoom; ++i)
      batch_->set(i, rays[static_cast<std::size_t>(std::min(i, batch_->count - 1))],
                  std::numeric_limits<T>::infinity());
    groups_ = LaneGroups::covering(0, batch_->count, kWidth<T>);
    search();
    kernel_->surface(*batch_, *hits_, groups_, *surface_);
  }
  const SurfaceBatch<T>& surface() const { return *surface_; }

  // Continues the rays of meet() from their hits along `directions`, one per hit. Returns the number of rays
  // that hit the object again.
  int met_again(std::span<const Vec3<T>> directions) {
    const int count = batch_->count;
    for (int i = 0; i < kBatchRoom; ++i)
      batch_->direction.set(i, directions[static_cast<std::size_t>(std::min(i, count - 1))]);
    for (const int i : groups_) batch_->origin.put(i, surface_->origin_toward(i, batch_->direction.at(i)));
    search();
    int met = 0;
    for (int i = 0; i < count; ++i) met += hits_->primitive[i] != kNoPrimitive;
    return met;
  }

 private:
  void search() {
    hits_->t.values = batch_->t_max.values;
    hits_->primitive.values.fill(kNoPrimitive);
    AcceleratorCounts counts;
    kernel_->closest(0, *batch_, groups_, *hits_, counts);
  }

  std::shared_ptr<const Scene> scene_;
  ShapeKernelPtr<T> kernel_;
  std::unique_ptr<RayBatch<T>> batch_ = std::make_unique<RayBatch<T>>();
  std::unique_ptr<HitBatch<T>> hits_ = std::make_unique<HitBatch<T>>();
  std::unique_ptr<SurfaceBatch<T>> surface_ = std::make_unique<SurfaceBatch<T>>();
  LaneGroups groups_;
};

}  // namespace orrery
