#pragma once

#include "core/stages/sampled_light.h"

namespace orrery {

// Emitted light that diffuse lobes find, along one sampled direction per surface point. It is weighted
// against sampled light sources and includes no reflected light. Not thread-safe: each object owns its
// batches.
template <class T>
class DiffuseRays {
 public:
  // Makes the stage. All arguments must outlive it.
  DiffuseRays(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan,
              SampledLight<T>& light)
      : geometry_(geometry), accelerator_(accelerator), plan_(plan), light_(light) {}

  // Adds the light to the radiance of the surface points of `met`.
  void add(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
           const SurfaceBatch<T>& surface, const LaneGroups& met, Vec3Array<T>& radiance,
           TraceCounts& counts);

 private:
  using N = Lanes<T>;
  // Samples directions and makes rays_ of them. Returns the registers with a ray.
  LaneGroups draw(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
                  const SurfaceBatch<T>& surface, const LaneGroups& met);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  SampledLight<T>& light_;
  ScatterBatch<T> drawn_;
  PathBatch<T> rays_;  // each in the lane of its surface point
  HitBatch<T> hits_;
  SurfaceBatch<T> surface_;  // materials only
  Vec3Array<T> found_;
};

extern template class DiffuseRays<float>;
extern template class DiffuseRays<double>;

}  // namespace orrery
