#pragma once

#include <memory>

#include "core/model/accelerator.h"
#include "core/model/scene.h"

// Instances: one model, with a structure of its own, met in many places. Rays are taken to the model's
// coordinates with their direction's length as it comes out, so that distances stay those of the world.
namespace orrery {

// A model in a render's precision. Its primitives are numbered from 0.
template <class T>
struct ModelGeometry {
  std::vector<ShapeKernelPtr<T>> shapes;
  PrimitiveList<T> primitives;
  Boundsd bounds;  // of all
  AcceleratorPtr<T> accelerator;
};

// A model somewhere.
template <class T>
struct Placed {
  std::shared_ptr<const ModelGeometry<T>> model;
  int first, last;  // numbers of its primitives in the scene: first..last-1
  Affine<T> world_from_model, model_from_world;
  T step_scale, step_base;  // the step off a surface in the world: from the model's, and what is added

  Ray<Lanes<T>> to_model(const Ray<Lanes<T>>& ray) const {
    const auto from_world = model_from_world.template as<Lanes<T>>();
    return {from_world.point(ray.origin), from_world.vector(ray.direction)};
  }
};
template <class T>
using PlacedList = std::vector<Placed<T>>;

// Box of a placed box. REQUIRES: it is bounded.
Boundsd box_around(const Boundsd& model, const Affined& world_from_model);

// Box of a placed model in the world, grown for the rounding of rays that are taken to it in float.
Boundsd bounds_of(const Boundsd& model, const Affined& world_from_model);

// The instances of a scene as primitives, whose hits have the numbers of the models' own.
template <class T>
class InstanceKernel final : public ShapeKernel<T> {
 public:
  explicit InstanceKernel(PlacedList<T> placed)
      : placed_(std::make_shared<const PlacedList<T>>(std::move(placed))) {}

  void closest(int index, const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override;
  void occlude(int index, RayBatch<T>& rays, const Groups& groups, AcceleratorCounts& counts) const override;
  std::vector<HullTriangle> hull(int) const override { return {}; }
  PackedPrimitivesPtr<T> pack(std::span<const int> indices) const override;
  void surface(const RayBatch<T>& rays, const HitBatch<T>& hits, const Groups& groups,
               SurfaceBatch<T>& out) const override;
  void parameters(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
                  SurfaceBatch<T>& out) const override;

 private:
  // Calls visit(i, mask, placed, ids within its model) for each register of `groups` and each instance that
  // is hit in it.
  template <class Visit>
  void for_each_hit(const HitBatch<T>& hits, const Groups& groups, const Visit& visit) const;

  std::shared_ptr<const PlacedList<T>> placed_;
};

extern template class InstanceKernel<float>;
extern template class InstanceKernel<double>;

}  // namespace orrery
