#include "core/lighting/energy_account.h"

#include "core/lighting/shadowed_light.h"

namespace orrery {
namespace {

// Calls visit(lane, sums of the lane's material) for each hit of `met`.
template <class T, class Visit>
void for_each_hit(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                  const LaneGroups& met, std::vector<EnergySums>& energy, const Visit& visit) {
  for (const int i : met)
    for (int lane = i; lane < std::min(i + kWidth<T>, paths.rays.count); ++lane)
      if (hits.primitive[lane] != kNoPrimitive)
        visit(lane, energy[static_cast<std::size_t>(surface.material[lane])]);
}

}  // namespace

template <class T>
void EnergyAccount<T>::add(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                           const PathDraws<T>& draws, const LaneGroups& met, TraceCounts& counts) {
  std::vector<EnergySums>& energy = counts.energy;
  energy.resize(geometry_.scene->material_names.size());
  const auto share = [&](int lane) {
    const Vec3<T> weight = sampled_.weight[lane];
    return EnergySums::rounded((double(weight.x) + double(weight.y) + double(weight.z)) / 3);
  };
  sample_materials(geometry_, paths.rays, hits, surface, draws, met, Lobes::diffuse, sampled_);
  for_each_hit(paths, hits, surface, met, energy, [&](int lane, EnergySums& sums) {
    ++sums.hits;
    sums.diffuse += share(lane);
  });
  sample_materials(geometry_, paths.rays, hits, surface, draws, met, Lobes::non_diffuse, sampled_);
  for_each_hit(paths, hits, surface, met, energy, [&](int lane, EnergySums& sums) {
    const bool through = dot(sampled_.direction[lane], surface.geometric[lane]) < 0;
    (through ? sums.transmitted : sums.specular) += share(lane);
  });
}

template class EnergyAccount<float>;
template class EnergyAccount<double>;

}  // namespace orrery
