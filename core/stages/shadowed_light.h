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
  // Geometry, accelerator and plan outlive it. `apart`: whether diffuse lobes are told apart.
  ShadowedLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan,
                bool apart = false)
      : geometry_(geometry), accelerator_(accelerator), plan_(plan), apart_(apart) {}

  // Evaluates the materials of `groups` and traces the shadow rays of what they answer. Returns the registers
  // with such a lane; light.shadow.t_max is positive where the light is seen. constant_half: see Directions.
  Groups find(const PathBatch<T>& paths, const SurfaceBatch<T>& surface, const Groups& groups,
              bool constant_half, TraceCounts& counts);

  LightBatch<T> light;
  // What surfaces do with it: see MaterialKernel::evaluate(). Undefined but for the registers found.
  Vec3Array<T> f_cos;
  Array<T> pdf;
  // If told apart, the same of diffuse lobes: f_cos and pdf are then of all others.
  Vec3Array<T> diffuse;
  Array<T> diffuse_pdf;

 private:
  // Sets `diffuse`, and completes f_cos where diffuse lobes answer alone.
  void evaluate_diffuse(const Directions<T>& directions, const SurfaceBatch<T>& surface,
                        const Groups& groups);
  const Geometry<T>& geometry_;
  const Accelerator<T>& accelerator_;
  const Plan& plan_;
  bool apart_;
};

// Sets f_cos and pdf of all lanes of `groups` by these lobes of their materials; pdf is 0 where they are not
// lit.
template <class T>
void evaluate_materials(const Geometry<T>& geometry, const Directions<T>& directions,
                        const SurfaceBatch<T>& surface, const Groups& groups, Lobes lobes,
                        Vec3Array<T>& f_cos, Array<T>& pdf) {
  for (const int i : groups) pdf.put(i, Lanes<T>(T(0)));
  for (const auto& m : geometry.materials)
    if (m.traits.lit && m.traits.has(lobes))
      m.kernel->evaluate(directions, surface, groups, lobes, f_cos, pdf);
}

// Sets the radiance of the lanes of `groups` whose materials are lit and have such lobes to what these make
// of ambient light.
template <class T>
void add_ambient(const Geometry<T>& geometry, const RayBatch<T>& rays, const SurfaceBatch<T>& surface,
                 const Groups& groups, Lobes lobes, Vec3Array<T>& radiance) {
  for (const auto& m : geometry.materials)
    if (m.traits.lit && m.traits.has(lobes))
      m.kernel->ambient(rays, surface, groups, lobes, geometry.ambient, radiance);
}

extern template class ShadowedLight<float>;
extern template class ShadowedLight<double>;

}  // namespace orrery
