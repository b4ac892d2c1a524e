#include "core/lighting/shadowed_light.h"

namespace orrery {

template <class T>
void ShadowedLight<T>::evaluate_diffuse(const Directions<T>& directions, const SurfaceBatch<T>& surface,
                                        const LaneGroups& groups) {
  using N = Lanes<T>;
  const N zero(T(0));
  evaluate_materials(geometry_, directions, surface, groups, Lobes::diffuse, diffuse, diffuse_pdf);
  for (const int i : groups) {
    diffuse.put(i, !(diffuse_pdf.at(i) > zero), Vec3<N>(zero));
    pi_bsdf_cos.put(i, !(pdf.at(i) > zero), Vec3<N>(zero));
  }
}

// Shadow rays start on the side of the surface that faces the light.
template <class T>
LaneGroups ShadowedLight<T>::find(const PathBatch<T>& paths, const SurfaceBatch<T>& surface,
                                  const LaneGroups& groups, bool constant_half, TraceCounts& counts) {
  using N = Lanes<T>;
  RayBatch<T>& shadow = light.shadow;
  const Directions<T> directions{paths.rays.direction, shadow.direction, shadow.t_max, constant_half};
  evaluate_materials(geometry_, directions, surface, groups, apart_ ? Lobes::non_diffuse : Lobes::all,
                     pi_bsdf_cos, pdf);
  if (apart_) evaluate_diffuse(directions, surface, groups);
  LaneGroups reached;
  for (const int i : groups) {
    const N zero(T(0));
    auto lit = pdf.at(i) > zero;
    if (apart_) lit = lit || diffuse_pdf.at(i) > zero;
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
  if (geometry_.atmosphere) geometry_.atmosphere->transmit_light(shadow.t_max, reached, light.incident);
  return reached;
}

template class ShadowedLight<float>;
template class ShadowedLight<double>;

}  // namespace orrery
