#pragma once

#include "core/lighting/lane_masks.h"
#include "core/model/path.h"

namespace orrery {

// Evaluates the specular materials of the registers of `groups`. If `filters`, multiplies the throughput of
// rays that hit these materials by SpecularBatch::filter.
template <class T>
void evaluate_specular(const Geometry<T>& geometry, bool filters, const HitBatch<T>& hits,
                       const SurfaceBatch<T>& surface, const LaneGroups& groups, PathBatch<T>& paths,
                       SpecularBatch<T>& out) {
  for (const auto& m : geometry.materials)
    if (m.traits.mirrors) m.kernel->specular(paths.rays, hits, surface, groups, out);
  if (!filters) return;
  for (const int i : groups) {
    const auto filtered = lanes_with(geometry, surface, i, &MaterialTraits::mirrors);
    paths.throughput.put(i, filtered, paths.throughput.at(i) * out.filter.at(i));
  }
}

}  // namespace orrery
