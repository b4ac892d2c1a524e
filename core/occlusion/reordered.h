#pragma once

#include <array>

#include "core/model/accelerator.h"

namespace orrery {

// Sorted places of active rays in a batch.
struct RayOrder {
  int count = 0;
  std::array<std::uint16_t, kBatch> place;  // `count` entries are valid
};

// Sorts the active rays of `groups` so that similar rays are adjacent. Rays are sorted by the cell of the
// origin, along a Morton curve in the bounding box of the active origins, and then by the cell of the
// direction. The first three bits of the direction are its octant. Keys are integers, equal keys keep their
// order, and NaN counts as the lowest cell (Garanzha, Loop, "Fast Ray Sorting and Breadth-First Packet
// Traversal for GPU Ray Tracing", 2010).
template <class T>
RayOrder order_of(const RayBatch<T>& rays, const LaneGroups& groups);

// Returns an accelerator that traces rays with `behind` in the order of order_of(), with the same results.
// `timed`: RayBatch::time is filled.
template <class T>
std::shared_ptr<const Accelerator<T>> reordered(std::shared_ptr<const Accelerator<T>> behind,
                                                bool timed = false);

}  // namespace orrery
