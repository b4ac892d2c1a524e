#pragma once

#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/world.h"

namespace orrery {

// Counts the light that materials reflect, transmit and absorb at the hits of all rays. Each hit samples one
// direction of the diffuse lobes and one of the others. The weight of a sampled direction is an unbiased
// estimate of the albedo of the lobes, and exact for smooth and Lambertian materials. Not thread-safe.
template <class T>
class EnergyAccount {
 public:
  explicit EnergyAccount(const Geometry<T>& geometry) : geometry_(geometry) {}  // must outlive this object

  // Adds the hits of `met` to counts.energy.
  void add(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
           const PathDraws<T>& draws, const LaneGroups& met, TraceCounts& counts);

 private:
  const Geometry<T>& geometry_;
  ScatterBatch<T> sampled_;
};

extern template class EnergyAccount<float>;
extern template class EnergyAccount<double>;

}  // namespace orrery
