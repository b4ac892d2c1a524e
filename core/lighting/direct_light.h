#pragma once

#include "core/lighting/light_selector.h"
#include "core/lighting/shadowed_light.h"
#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"

namespace orrery {

// Direct light from all light sources, evaluated one after another. Used by techniques derived from
// SpecularTree. Not thread-safe: each object owns its batches.
template <class T>
class DirectLight {
 public:
  // Geometry, accelerator and plan must outlive this object.
  DirectLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
      : geometry_(geometry), plan_(plan), lights_(geometry), shadowed_(geometry, accelerator, plan) {}

  // Sets `radiance` of lanes with lit materials to their reflected ambient light. Adds the reflected light of
  // each source unless Plan::direct_light is false. `groups` are the registers with a lit material. Calls
  // checkpoint() before each light.
  void add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
           const LaneGroups& groups, Vec3Array<T>& radiance, TraceCounts& counts);

 private:
  using N = Lanes<T>;

  const Geometry<T>& geometry_;
  const Plan& plan_;
  const LightSelector<T> lights_;
  ShadowedLight<T> shadowed_;
};

extern template class DirectLight<float>;
extern template class DirectLight<double>;

}  // namespace orrery
