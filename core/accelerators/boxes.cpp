#include "core/accelerators/unbounded.h"

namespace orrery {
namespace {

// List of primitives. A bounded primitive is tested only if a ray of the register enters its axis-aligned
// box. Every ray tests all unbounded primitives.
template <class T>
class Boxes final : public Accelerator<T> {
 public:
  explicit Boxes(const PrimitiveList<T>& primitives) : unbounded_(primitives) {
    for (const auto& primitive : primitives)
      if (primitive.bounds.bounded())
        boxed_.push_back({padded<T>(primitive.bounds), primitive.kernel, primitive.index});
  }

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    unbounded_.closest(rays, groups, hits, counts);
    for (const int i : groups) {
      const BoxRay<N> ray(rays.origin.at(i), rays.direction.at(i));
      const LaneGroups one = LaneGroups::single(i);
      counts.box_tests += boxed_.size() * active_rays(rays, one);
      for (const Boxed& b : boxed_) {
        const auto entered = enters(ray, Vec3<N>(b.box.lo), Vec3<N>(b.box.hi), hits.t.at(i));
        if (!any(entered)) continue;
        counts.primitive_tests += static_cast<std::uint64_t>(stdx::popcount(entered));
        b.kernel->closest(b.index, rays, one, hits, counts);
      }
    }
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const LaneGroups open = unbounded_.occlude(rays, groups, counts);
    for (const int i : open) occlude_register(rays, i, counts);
  }

  AcceleratorFacts facts() const override {
    return {.bytes = boxed_.size() * sizeof(Boxed) + unbounded_.bytes(),
            .depth = 1,
            .references = boxed_.size() + unbounded_.size()};
  }

 private:
  using N = Lanes<T>;
  struct Boxed {
    Bounds<T> box;
    const ShapeKernel<T>* kernel;
    int index;
  };

  void occlude_register(RayBatch<T>& rays, int i, AcceleratorCounts& counts) const {
    const BoxRay<N> ray(rays.origin.at(i), rays.direction.at(i));
    const LaneGroups one = LaneGroups::single(i);
    for (const Boxed& b : boxed_) {
      const N t_max = rays.t_max.at(i);
      const auto active = t_max > N(T(0));
      if (!any(active)) return;
      counts.box_tests += static_cast<std::uint64_t>(stdx::popcount(active));
      const auto entered = enters(ray, Vec3<N>(b.box.lo), Vec3<N>(b.box.hi), t_max);
      if (!any(entered)) continue;
      counts.primitive_tests += static_cast<std::uint64_t>(stdx::popcount(entered));
      b.kernel->occlude(b.index, rays, one, counts);
    }
  }

  std::vector<Boxed> boxed_;
  Unbounded<T> unbounded_;
};

}  // namespace

AcceleratorType boxes_type() {
  return {"boxes",
          "List of primitives. Rays test the axis-aligned box of each primitive first.",
          {.ray = 0, .visit = 0, .box = 0.25, .primitive = 2.6, .each = 0.25},
          build_accelerator<Boxes, float>,
          build_accelerator<Boxes, double>};
}

}  // namespace orrery
