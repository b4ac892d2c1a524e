#include "core/lighting/environment_lighting.h"

#include "core/lighting/lane_masks.h"
#include "core/lighting/light_tree.h"
#include "core/lighting/power_heuristic.h"

namespace orrery {

template <class T>
void EnvironmentLighting<T>::add(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
                                 const Array<T>* by_lobe, Vec3Array<T>& radiance) {
  if (empty()) return;
  LaneGroups missed;
  for (const int i : groups)
    if (any(missed_lanes(hits, i))) missed.add(i);
  if (missed.empty()) return;
  const N zero(T(0)), one(T(1));
  for (const Source& source : sources_) {
    source.kernel->beyond(rays, source.choice, missed, found_, by_light_);
    if (by_lobe && source.tree) weigh_choice(source, rays, missed, *by_lobe);
    for (const int i : missed) {
      N weight = one;
      if (by_lobe) {
        const N lobe = by_lobe->at(i), light = by_light_.at(i);
        weight = select(lobe > zero && light > zero, power_heuristic(lobe, light), one);
      }
      radiance.put(i, missed_lanes(hits, i), radiance.at(i) + found_.at(i) * weight);
    }
  }
}

template <class T>
void EnvironmentLighting<T>::weigh_choice(const Source& source, const RayBatch<T>& rays,
                                          const LaneGroups& missed, const Array<T>& by_lobe) {
  const N zero(T(0));
  for (const int i : missed)
    for (unsigned bits = bits_of(MaskOf<N>(by_lobe.at(i) > zero && by_light_.at(i) > zero)); bits != 0;
         bits &= bits - 1) {
      const int lane = i + std::countr_zero(bits);
      by_light_[lane] *= source.tree->probability(rays.origin[lane], source.number);
    }
}

template class EnvironmentLighting<float>;
template class EnvironmentLighting<double>;

}  // namespace orrery
