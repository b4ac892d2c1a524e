#pragma once

#include "core/lighting/atmosphere_stage.h"
#include "core/lighting/sampled_light.h"

namespace orrery {

// Light of emitters and the background that diffuse lobes reflect, found by tracing one sampled direction per
// surface point. The light is weighted against light sampling. Light that the hit surfaces reflect is not
// included. Not thread-safe: each object owns its batches.
template <class T>
class DiffuseRays {
 public:
  // All arguments must outlive this object.
  DiffuseRays(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan,
              SampledLight<T>& light)
      : geometry_(geometry), accelerator_(accelerator), plan_(plan), light_(light) {
    if (geometry.atmosphere) atmosphere_ = std::make_unique<AtmosphereStage<T>>(geometry, plan);
  }

  // Adds the light that the surfaces of `met` reflect to `radiance`, and the rays to `counts`.
  void add(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
           const SurfaceBatch<T>& surface, const LaneGroups& met, Vec3Array<T>& radiance,
           TraceCounts& counts);

 private:
  using N = Lanes<T>;
  // Samples directions and fills rays_ with rays along them. Returns the registers with at least one ray.
  LaneGroups draw(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
                  const SurfaceBatch<T>& surface, const LaneGroups& met);

  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  SampledLight<T>& light_;
  std::unique_ptr<AtmosphereStage<T>> atmosphere_;  // null if the scene has no atmosphere
  ScatterBatch<T> drawn_;
  PathBatch<T> rays_;  // the ray of a surface point has the same lane
  HitBatch<T> hits_;
  SurfaceBatch<T> surface_;  // only `material` is filled
  Vec3Array<T> found_;
};

extern template class DiffuseRays<float>;
extern template class DiffuseRays<double>;

}  // namespace orrery
