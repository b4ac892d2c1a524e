#pragma once

#include "core/stages/sampled_light.h"

namespace orrery {

// Light that diffuse lobes find along directions which they draw, one a surface point: what shines there,
// weighted against light sources that are drawn, and nothing else. One object belongs to one thread: it keeps
// its batches.
template <class T>
class DiffuseRays {
 public:
  // All outlive it.
  DiffuseRays(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan,
              SampledLight<T>& light)
      : geometry_(geometry), accelerator_(accelerator), plan_(plan), light_(light) {}

  // Adds it to the radiance of the surface points of `met`.
  void add(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
           const SurfaceBatch<T>& surface, const Groups& met, Vec3Array<T>& radiance, TraceCounts& counts);

 private:
  using N = Lanes<T>;
  // Draws directions and makes rays_ of them. Returns the registers with a ray.
  Groups draw(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
              const SurfaceBatch<T>& surface, const Groups& met);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  SampledLight<T>& light_;
  ScatterBatch<T> drawn_;
  PathBatch<T> rays_;  // each in the lane of its surface point
  HitBatch<T> hits_;
  SurfaceBatch<T> surface_;  // materials alone
  Vec3Array<T> found_;
};

extern template class DiffuseRays<float>;
extern template class DiffuseRays<double>;

}  // namespace orrery
