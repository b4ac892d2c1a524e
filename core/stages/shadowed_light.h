#pragma once

#include "core/model/counts.h"
#include "core/model/path.h"
#include "core/model/plan.h"
#include "core/model/world.h"

namespace orrery {

// Light on its way from light sources to surfaces: who fills `light` has surfaces answer it and asks whether
// anything stands in between. One object belongs to one thread: it keeps its batches.
template <class T>
class ShadowedLight {
 public:
  // Geometry, accelerator and plan outlive it.
  ShadowedLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan)
      : geometry_(geometry), accelerator_(accelerator), plan_(plan) {}

  // Evaluates the materials of `groups` and traces the shadow rays of what they answer. Returns the registers
  // with such a lane; light.shadow.t_max is positive where the light is seen. constant_half: see Directions.
  Groups find(const PathBatch<T>& paths, const SurfaceBatch<T>& surface, const Groups& groups,
              bool constant_half, TraceCounts& counts);

  LightBatch<T> light;
  // What surfaces do with it: see MaterialKernel::evaluate(). Undefined but for the registers found.
  Vec3Array<T> f_cos;
  Array<T> pdf;

 private:
  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
};

// Sets f_cos and pdf of all lanes of `groups` by their materials; pdf is 0 where they are not lit.
template <class T>
void evaluate_materials(const Geometry<T>& geometry, const Directions<T>& directions,
                        const SurfaceBatch<T>& surface, const Groups& groups, Vec3Array<T>& f_cos,
                        Array<T>& pdf) {
  for (const int i : groups) pdf.put(i, Lanes<T>(T(0)));
  for (const auto& m : geometry.materials)
    if (m.traits.lit) m.kernel->evaluate(directions, surface, groups, f_cos, pdf);
}

extern template class ShadowedLight<float>;
extern template class ShadowedLight<double>;

}  // namespace orrery
