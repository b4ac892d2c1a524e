#pragma once

#include <memory>

#include "core/accelerators/instance_kernel.h"
#include "core/model/accelerator.h"
#include "core/model/scene.h"

// Instances: models with their own acceleration structure, placed any number of times. Rays are transformed
// to model coordinates without normalising the direction, so hit distances are the same as in the world.
namespace orrery {

// Model in the number type of a render. Its primitives are numbered from 0.
template <class T>
struct ModelGeometry {
  std::vector<ShapeKernelPtr<T>> shapes;
  PrimitiveList<T> primitives;
  Boundsd bounds;  // box around all primitives
  AcceleratorPtr<T> accelerator;
};

// Static instance of a model.
template <class T>
struct PlacedInstance {
  std::shared_ptr<const ModelGeometry<T>> model;
  int first, last;  // primitives of the instance: numbers [first, last) in the scene
  Affine<T> world_from_model, model_from_world;
  T step_scale, step_base;  // SurfaceBatch::step in the world is step_scale * step in the model + step_base

  static constexpr bool kTimed = false;
  struct Pose {
    using N = Lanes<T>;
    Affine<N> world_from_model, model_from_world;

    Ray<N> to_model(const Ray<N>& ray) const {
      return {model_from_world.point(ray.origin), model_from_world.vector(ray.direction)};
    }
    Vec3<N> point(const Vec3<N>& p) const { return world_from_model.point(p); }
    Vec3<N> vector(const Vec3<N>& v) const { return world_from_model.vector(v); }
    Vec3<N> normal(const Vec3<N>& n) const { return model_from_world.transposed(n); }
  };
  [[gnu::always_inline]] Pose pose() const {
    return {world_from_model.template as<Lanes<T>>(), model_from_world.template as<Lanes<T>>()};
  }
  [[gnu::always_inline]] Pose pose(const RayBatch<T>&, int) const { return pose(); }
};
template <class T>
using PlacedList = std::vector<PlacedInstance<T>>;

// Returns the box around a transformed box. REQUIRES: `model` is bounded.
Boundsd box_around(const Boundsd& model, const Affined& world_from_model);

// Returns the world box of a placed model, padded for the rounding of rays transformed in float. Returns an
// infinite box if the model is unbounded.
Boundsd bounds_of(const Boundsd& model, const Affined& world_from_model);

// Kernel of the static instances of a scene. Hits contain the number of the hit primitive in the scene.
template <class T>
class InstanceKernel final : public InstanceKernelOf<T, PlacedInstance<T>> {
 public:
  using InstanceKernelOf<T, PlacedInstance<T>>::InstanceKernelOf;
  PackedPrimitivesPtr<T> pack(std::span<const int> indices) const override;
};

extern template class InstanceKernel<float>;
extern template class InstanceKernel<double>;

}  // namespace orrery
