#include "core/techniques/specular_tree.h"

#include "core/lighting/emission.h"
#include "core/lighting/specular.h"

namespace orrery {

template <class T>
SpecularTree<T>::SpecularTree(const World<T>& world, const Plan& plan)
    : Wavefront<T>(world, plan), direct_light_(this->geometry_, this->accelerator_, this->plan_) {
  if (this->geometry_.environment) environment_lighting_.see(*this->geometry_.environment, {0, 0});
}

template <class T>
void SpecularTree<T>::shade(const LaneGroups& groups, const LaneGroups& met) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  environment_lighting_.add(paths->rays, hits, groups, nullptr, radiance);
  shade_surfaces(met);
}

template <class T>
void SpecularTree<T>::shade_surfaces(const LaneGroups& met) {
  auto& [paths, hits, surface, radiance] = *this->vertices_;
  const Geometry<T>& geometry = this->geometry_;
  direct_light_.add(*paths, this->draws(), surface, groups_with(geometry, surface, met, &MaterialTraits::lit),
                    radiance, this->counts());
  add_emission(geometry, surface, met, radiance);
  if (!this->plan_.specular) return;
  const LaneGroups specular = groups_with(geometry, surface, met, &MaterialTraits::mirrors);
  evaluate_specular(geometry, this->plan_.filters, hits, surface, specular, *paths, specular_);
  scatter(specular);
}

template <class T>
void SpecularTree<T>::follow(Kind kind, int i, const MaskOf<N>& mask, const Vec3<N>& direction,
                             const Vec3<N>& weight) {
  const auto& paths = *this->vertices_->paths;
  const Plan& plan = this->plan_;
  const auto wanted = mask && max_component(weight) > N(T(0));
  if (!any(wanted)) return;
  const Vec3<N> throughput = paths.throughput.at(i) * weight;
  auto traced = wanted;
  if (paths.depth >= plan.max_depth)
    traced = typename N::mask_type(false);
  else if (plan.min_contribution > 0)
    traced = wanted && max_component(throughput) >= N(static_cast<T>(plan.min_contribution));
  if (!all(traced == wanted)) cut(i, wanted && !traced, direction, weight);
  if (any(traced)) this->spawn(kind, i, traced, direction, throughput);
}

template <class T>
void SpecularTree<T>::cut(int i, const MaskOf<N>& mask, const Vec3<N>& direction, const Vec3<N>& weight) {
  add_ambient(i, mask, weight);
  this->record_omitted(i, mask, this->vertices_->paths->throughput.at(i) * weight, direction);
}

template <class T>
void SpecularTree<T>::add_ambient(int i, const MaskOf<N>& mask, const Vec3<N>& weight) {
  auto& radiance = this->vertices_->radiance;
  radiance.put(i, mask, radiance.at(i) + weight * Vec3<N>(this->geometry_.ambient));
}

template class SpecularTree<float>;
template class SpecularTree<double>;

}  // namespace orrery
