#pragma once

#include "core/model/accelerator.h"

namespace orrery {

// Kind of query for a ray: its closest hit, or whether any primitive occludes it.
enum class Query { closest, occlude };

// Tests every ray of `groups` against every primitive. See Accelerator::closest().
template <class T>
void closest_exhaustive(const PrimitiveList<T>& primitives, const RayBatch<T>& rays, const LaneGroups& groups,
                        HitBatch<T>& hits, AcceleratorCounts& counts) {
  if (primitives.empty()) return;
  for (const auto& primitive : primitives)
    primitive.kernel->closest(primitive.index, rays, groups, hits, counts);
  counts.primitive_tests += primitives.size() * active_rays(rays, groups);
}

// Tests rays of `groups` against the primitives and sets t_max of occluded rays to -1. Returns the registers
// that still contain active rays.
template <class T>
LaneGroups occlude_exhaustive(const PrimitiveList<T>& primitives, RayBatch<T>& rays, const LaneGroups& groups,
                              AcceleratorCounts& counts) {
  LaneGroups open = groups;
  for (const auto& primitive : primitives) {
    counts.primitive_tests += active_rays(rays, open);
    primitive.kernel->occlude(primitive.index, rays, open, counts);
    open = with_active_rays(rays, open);
  }
  return open;
}

}  // namespace orrery
