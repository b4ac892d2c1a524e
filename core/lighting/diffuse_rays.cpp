#include "core/lighting/diffuse_rays.h"

#include "core/lighting/surfaces.h"

namespace orrery {

template <class T>
LaneGroups DiffuseRays<T>::draw(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
                                const SurfaceBatch<T>& surface, const LaneGroups& met) {
  const N zero(T(0)), one(T(1));
  sample_materials(geometry_, paths.rays, hits, surface, draws, met, Lobes::diffuse, drawn_);
  LaneGroups drawn;
  rays_.depth = paths.depth + 1;
  for (const int i : met) {
    const auto goes = max_component(drawn_.weight.at(i)) > zero;
    if (!any(goes)) continue;
    drawn.add(i);
    const Vec3<N> direction = select(goes, drawn_.direction.at(i), Vec3<N>(one));
    rays_.rays.origin.put(i, surface.origin_toward(i, direction));
    rays_.rays.direction.put(i, direction);
    rays_.rays.t_max.put(i, select(goes, N(std::numeric_limits<T>::infinity()), N(T(-1))));
    rays_.pdf.put(i, select(goes, drawn_.pdf.at(i), zero));
    if (plan_.shutter > 0) rays_.rays.time.put(i, paths.rays.time.at(i));
  }
  return drawn;
}

template <class T>
void DiffuseRays<T>::add(const PathBatch<T>& paths, const HitBatch<T>& hits, const PathDraws<T>& draws,
                         const SurfaceBatch<T>& surface, const LaneGroups& met, Vec3Array<T>& radiance,
                         TraceCounts& counts) {
  const LaneGroups drawn = draw(paths, hits, draws, surface, met);
  if (drawn.empty()) return;
  if (paths.depth < kMaxRayDepth)
    counts.rays.reflected[static_cast<std::size_t>(rays_.depth)] += active_rays(rays_.rays, drawn);
  reset(rays_.rays, drawn, hits_);
  accelerator_.closest(rays_.rays, drawn, hits_, counts.accelerator);
  const Vec3<N> nothing(N(T(0))), background(geometry_.background);
  for (const int i : drawn) {
    find_materials(geometry_, hits_, i, surface_);
    found_.put(i, select(missed_lanes(hits_, i), background, nothing));
  }
  light_.add_environment(rays_, hits_, drawn, found_);
  light_.add_emission(rays_, hits_, surface_, drawn, found_);
  if (atmosphere_) {
    atmosphere_->find(rays_.rays, rays_.depth, hits_, drawn);
    for (const int i : drawn) found_.put(i, found_.at(i) * atmosphere_->share(i));
  }
  for (const int i : drawn)
    radiance.put(i, rays_.rays.t_max.at(i) > N(T(0)), radiance.at(i) + drawn_.weight.at(i) * found_.at(i));
}

template class DiffuseRays<float>;
template class DiffuseRays<double>;

}  // namespace orrery
