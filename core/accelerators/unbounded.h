#pragma once

#include "core/model/accelerator.h"

namespace orrery {

// The primitives without bounds (planes, endless cylinders): no box holds them, so every ray tests them all.
template <class T>
class Unbounded {
 public:
  explicit Unbounded(const PrimitiveList<T>& primitives) {
    for (const auto& primitive : primitives)
      if (!primitive.bounds.bounded()) primitives_.push_back(primitive);
  }

  void closest(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const {
    if (primitives_.empty()) return;
    for (const auto& primitive : primitives_) primitive.kernel->closest(primitive.index, rays, groups, hits);
    counts.primitive_tests += primitives_.size() * active_rays(rays, groups);
  }

  // Returns the registers with rays that met none of them.
  Groups occlude(RayBatch<T>& rays, const Groups& groups, AcceleratorCounts& counts) const {
    Groups open = groups;
    for (const auto& primitive : primitives_) {
      counts.primitive_tests += active_rays(rays, open);
      primitive.kernel->occlude(primitive.index, rays, open);
      open = with_active_rays(rays, open);
    }
    return open;
  }

  std::size_t bytes() const { return primitives_.size() * sizeof(Primitive<T>); }

 private:
  PrimitiveList<T> primitives_;
};

}  // namespace orrery
