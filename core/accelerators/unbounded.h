#pragma once

#include "core/accelerators/exhaustive.h"

namespace orrery {

// Unbounded primitives (planes, infinite cylinders). They have no finite box, so every ray tests all of them.
template <class T>
class Unbounded {
 public:
  explicit Unbounded(const PrimitiveList<T>& primitives) {
    for (const auto& primitive : primitives)
      if (!primitive.bounds.bounded()) primitives_.push_back(primitive);
  }

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const {
    closest_exhaustive(primitives_, rays, groups, hits, counts);
  }

  // Sets t_max of occluded rays to -1. Returns the registers that still contain active rays.
  LaneGroups occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const {
    return occlude_exhaustive(primitives_, rays, groups, counts);
  }

  std::size_t size() const { return primitives_.size(); }
  std::size_t bytes() const { return primitives_.size() * sizeof(Primitive<T>); }

 private:
  PrimitiveList<T> primitives_;
};

}  // namespace orrery
