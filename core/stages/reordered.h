#pragma once

#include <array>

#include "core/model/accelerator.h"

namespace orrery {

// Active rays of a batch, by their places in it.
struct RayOrder {
  int count = 0;
  std::array<std::uint16_t, kBatch> place;  // the first `count` are there
};

// The active rays of `groups` such that those that are alike follow each other: by the cell of the origin
// within the box of all origins along a Morton curve, then by the direction likewise, whose first three bits
// are the octant. Keys are integers, equal ones keep their order, and NaN counts as the lowest
// cell (Garanzha, Loop, "Fast Ray Sorting and Breadth-First Packet Traversal for GPU Ray Tracing", 2010).
template <class T>
RayOrder order_of(const RayBatch<T>& rays, const Groups& groups);

// Asks `behind` for rays in that order; its answers are the same. `timed`: rays have times.
template <class T>
std::shared_ptr<const Accelerator<T>> reordered(std::shared_ptr<const Accelerator<T>> behind,
                                                bool timed = false);

}  // namespace orrery
