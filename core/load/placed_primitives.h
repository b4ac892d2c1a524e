#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/model/batch.h"
#include "core/model/scene.h"

namespace orrery {

// Primitive in the world at one time.
struct PlacedPrimitive {
  bool moves;
  std::size_t object;  // index into Scene::object_runs
  const ShapeSet* shapes;
  const ShapeKernel<double>* kernel;
  int index, number;  // index in the set; number in the scene
  Affined world_from_model, model_from_world;
  Boundsd box;  // in the world
};

struct SurfaceAt {
  Vec3d position;
  Vec3d outward;    // unit geometric normal
  Vec3d shading;    // shading normal, smoothed on meshes
  double distance;  // along the ray, in units of the length of its direction
};

// Intersects single rays with primitives and counts the tests. Used by one thread at a time.
class PrimitiveTester {
 public:
  // Returns the nearest hit of the primitive, or nullopt if the ray misses it.
  std::optional<SurfaceAt> intersect(const PlacedPrimitive& placed, const Ray<double>& ray);
  std::size_t tests() const { return tests_; }

 private:
  RayBatch<double> rays_{};
  HitBatch<double> hits_{};
  SurfaceBatch<double> met_{};
  std::size_t tests_ = 0;
};

// Returns false only if the ray misses the box.
bool may_meet(const Boundsd& box, const BoxRay<double>& ray);

// First 256 primitives of a scene, placed in the world at one time. Used by one thread at a time.
class PlacedPrimitives {
 public:
  static constexpr std::size_t kMost = 256;

  // Places nothing. REQUIRES: the scene lives longer.
  explicit PlacedPrimitives(const Scene& scene);
  // Replaces the primitives by those at `time`. Throws std::bad_alloc.
  void place_all(double time);

  const std::vector<PlacedPrimitive>& all() const { return placed_; }
  bool complete() const { return complete_; }  // false if primitives were skipped
  // Returns MaterialSet::mirrored_share() of the primitive's material.
  double mirrored_share(const PlacedPrimitive& placed) const {
    return shares_[static_cast<std::size_t>(scene_.material_of[static_cast<std::size_t>(placed.number)])];
  }

 private:
  void place(const std::vector<std::unique_ptr<ShapeSet>>& sets, const Affined& world, double time,
             bool moves, int& number);

  const Scene& scene_;
  std::vector<std::unique_ptr<ShapeSet>> moved_;
  std::deque<ShapeKernelPtr<double>> kernels_;                 // kernels of moving shapes
  std::map<const ShapeSet*, ShapeKernelPtr<double>> resting_;  // kernels of resting shapes
  std::vector<PlacedPrimitive> placed_;
  bool complete_ = true;
  std::vector<double> shares_;  // mirrored share of each material
};

}  // namespace orrery
