#include "core/lighting/direct_light.h"

#include "core/base/task_scope.h"

namespace orrery {

template <class T>
void DirectLight<T>::add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
                         const LaneGroups& groups, Vec3Array<T>& radiance, TraceCounts& counts) {
  if (groups.empty()) return;
  add_ambient(geometry_, paths.rays, surface, groups, Lobes::all, radiance);
  if (!plan_.direct_light) return;
  lights_.for_each([&](const LightKernel<T>& kernel, const LightChoice<T>& choice,
                       const LightTraits& traits) {
    checkpoint();
    kernel.sample(surface, choice, draws, groups, shadowed_.light);
    const bool constant_half = plan_.constant_half && paths.depth == 0 && traits.parallel;
    for (const int i : shadowed_.find(paths, surface, groups, constant_half, counts)) {
      const auto seen = shadowed_.light.shadow.t_max.at(i) > N(T(0));
      radiance.put(i, seen, radiance.at(i) + shadowed_.light.incident.at(i) * shadowed_.pi_bsdf_cos.at(i));
    }
  });
}

template class DirectLight<float>;
template class DirectLight<double>;

}  // namespace orrery
