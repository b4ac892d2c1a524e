#pragma once

#include "core/base/checkpoint.h"
#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"
#include "core/stages/light_selector.h"
#include "core/stages/shadowed_light.h"

namespace orrery {

// Light that reaches surfaces straight from light sources. Every technique shares this stage. One object
// belongs to one thread: it keeps its batches.
template <class T>
class DirectLight {
 public:
  // Geometry, accelerator and plan outlive it.
  DirectLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
      : geometry_(geometry), plan_(plan), lights_(geometry), shadowed_(geometry, accelerator, plan) {}

  // Sets `radiance` of the lanes whose material is lit to what ambient light makes leave them, and adds what
  // each light does. `groups`: registers with such a lane. `checkpoint` is asked before each light; once the
  // work is to end the other lights are left.
  void add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
           const Groups& groups, Vec3Array<T>& radiance, TraceCounts& counts, const Checkpoint& checkpoint);

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
