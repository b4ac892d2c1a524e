#include "core/stages/shadowed_light.h"

namespace orrery {

// The light's direction decides on which side of the surface the shadow ray starts.
template <class T>
Groups ShadowedLight<T>::find(const PathBatch<T>& paths, const SurfaceBatch<T>& surface, const Groups& groups,
                              bool constant_half, TraceCounts& counts) {
  using N = Lanes<T>;
  RayBatch<T>& shadow = light.shadow;
  evaluate_materials(geometry_, {paths.rays.direction, shadow.direction, shadow.t_max, constant_half},
                     surface, groups, f_cos, pdf);
  Groups reached;
  for (const int i : groups) {
    const auto lit = pdf.at(i) > N(T(0));
    shadow.t_max.put(i, !lit, N(T(-1)));
    if (!any(lit)) continue;
    reached.add(i);
    shadow.origin.put(i, surface.origin_toward(i, shadow.direction.at(i)));
    if (plan_.shutter > 0) shadow.time.put(i, paths.rays.time.at(i));
  }
  if (plan_.shadows) {
    counts.rays.shadow[static_cast<std::size_t>(paths.depth)] += active_rays(shadow, reached);
    accelerator_.occlude(shadow, reached, counts.accelerator);
  }
  return reached;
}

template class ShadowedLight<float>;
template class ShadowedLight<double>;

}  // namespace orrery
