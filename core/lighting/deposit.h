#pragma once

#include "core/model/path.h"

namespace orrery {

// Adds the radiance of the rays of `groups`, times their throughput, to the sums of their camera rays in
// batch order. Sums are indexed by PathBatch::slot. Camera rays (depth 0) set their sums. For other depths,
// overwrites `radiance` with the products.
template <class T>
void deposit(const PathBatch<T>& paths, const LaneGroups& groups, Vec3Array<T>& radiance,
             Vec3Array<T>& slots) {
  if (paths.depth == 0) {
    for (const int i : groups) slots.put(i, radiance.at(i) * paths.throughput.at(i));
    return;
  }
  for (const int i : groups) {
    radiance.put(i, radiance.at(i) * paths.throughput.at(i));
    for (int lane = i; lane < std::min(i + kWidth<T>, paths.rays.count); ++lane) {
      const int slot = static_cast<int>(paths.slot[lane]);
      slots.x[slot] += radiance.x[lane];
      slots.y[slot] += radiance.y[lane];
      slots.z[slot] += radiance.z[lane];
    }
  }
}

}  // namespace orrery
