#include "core/model/accelerator.h"

namespace orrery {
namespace {

template <class T>
class List final : public Accelerator<T> {
 public:
  explicit List(const PrimitiveList<T>& primitives) : primitives_(primitives) {}

  void closest(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    for (const auto& primitive : primitives_) primitive.kernel->closest(primitive.index, rays, groups, hits);
    counts.primitive_tests += primitives_.size() * active_rays(rays, groups);
  }

  void occlude(RayBatch<T>& rays, const Groups& groups, AcceleratorCounts& counts) const override {
    Groups open = groups;
    for (const auto& primitive : primitives_) {
      counts.primitive_tests += active_rays(rays, open);
      primitive.kernel->occlude(primitive.index, rays, open);
      open = with_active_rays(rays, open);
    }
  }

  AcceleratorFacts facts() const override { return {}; }

 private:
  const PrimitiveList<T>& primitives_;
};

}  // namespace

AcceleratorType list_type() {
  return {"list", "Every ray against every primitive: the reference.", build_accelerator<List, float>,
          build_accelerator<List, double>};
}

}  // namespace orrery
