#pragma once

#include "core/accelerators/instances.h"
#include "core/math/elementary.h"
#include "core/math/motion_segments.h"

// Instances that move during the exposure, or whose models contain moving shapes. Each ray is transformed to
// model coordinates at the time of the ray.
namespace orrery {

// Instance in motion. Between consecutive moments, its scale, its translation and its angle about the
// rotation axis change linearly.
template <class T>
struct MovingInstance {
  using N = Lanes<T>;

  // Placement at one moment, and the change until the next moment.
  struct Moment {
    // Axes of the model after a rotation by angle a from this moment: along + across cos a + beyond sin a.
    // They are the component parallel to the rotation axis, the component perpendicular to it, and the cross
    // product of the rotation axis and the model axis.
    std::array<Vec3<T>, 3> along, across, beyond;
    T turns;                                               // rotation until the next moment, in turns
    Vec3<T> scale, more_scale, translate, more_translate;  // at this moment, and change until the next
  };

  std::shared_ptr<const ModelGeometry<T>> model;
  int first, last;  // primitives of the instance: numbers [first, last) in the scene
  MotionSegments<T> segments;
  std::vector<Moment> moments;  // one per motion segment: the moment at which it starts
  T step_scale, step_base;      // see PlacedInstance

  MovingInstance(const Instance& instance, std::shared_ptr<const ModelGeometry<T>> of, int number,
                 const Exposure& exposure);

  static constexpr bool kTimed = true;
  struct Pose {
    std::array<Vec3<N>, 3> axes;       // unit vectors of the model's x, y and z
    Vec3<N> scale, shrink, translate;  // shrink: 1 / scale

    Vec3<N> back(const Vec3<N>& v) const {
      return Vec3<N>(dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)) * shrink;
    }
    Vec3<N> turned(const Vec3<N>& v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
    Ray<N> to_model(const Ray<N>& ray) const { return {back(ray.origin - translate), back(ray.direction)}; }
    Vec3<N> point(const Vec3<N>& p) const { return turned(p * scale) + translate; }
    Vec3<N> vector(const Vec3<N>& v) const { return turned(v * scale); }
    Vec3<N> normal(const Vec3<N>& n) const { return turned(n * shrink); }
  };
  Pose pose(const RayBatch<T>& rays, int i) const {
    Pose now;
    now.scale = Vec3<N>(N(T(1)));
    segments.for_each(rays.time.at(i), [&](const auto& lanes, std::size_t moment, const N& share) {
      const Moment& from = moments[moment];
      const auto [sine, cosine] = sine_cosine_turns(N(share * from.turns));
      for (std::size_t k = 0; k < 3; ++k)
        now.axes[k] = select(
            lanes, Vec3<N>(from.along[k]) + Vec3<N>(from.across[k]) * cosine + Vec3<N>(from.beyond[k]) * sine,
            now.axes[k]);
      now.scale = select(lanes, Vec3<N>(from.scale) + Vec3<N>(from.more_scale) * share, now.scale);
      now.translate =
          select(lanes, Vec3<N>(from.translate) + Vec3<N>(from.more_translate) * share, now.translate);
    });
    const N one(T(1));
    now.shrink = {one / now.scale.x, one / now.scale.y, one / now.scale.z};
    return now;
  }
};

// Returns the box that an instance sweeps during an exposure, for a model with these bounds. The box is
// padded for the rounding of rays transformed in float.
Boundsd bounds_during(const Boundsd& model, const Instance& instance, const Exposure& exposure);

template <class T>
class MovingInstanceKernel final : public InstanceKernelOf<T, MovingInstance<T>> {
 public:
  using InstanceKernelOf<T, MovingInstance<T>>::InstanceKernelOf;
  PackedPrimitivesPtr<T> pack(std::span<const int>) const override { return nullptr; }
};

extern template struct MovingInstance<float>;
extern template struct MovingInstance<double>;

}  // namespace orrery
