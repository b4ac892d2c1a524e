#include "core/stages/direct_light.h"

namespace orrery {

template <class T>
void DirectLight<T>::add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
                         const Groups& groups, Vec3Array<T>& radiance, TraceCounts& counts,
                         const Checkpoint& checkpoint) {
  if (groups.empty()) return;
  for (const auto& m : geometry_.materials)
    if (m.traits.lit) m.kernel->ambient(surface, groups, geometry_.ambient, radiance);
  if (!plan_.direct_light) return;
  bool ends = false;
  lights_.for_each(
      [&](const LightKernel<T>& kernel, const LightChoice<T>& choice, const LightTraits& traits) {
        ends = ends || !checkpoint.go_on();
        if (ends) return;
        kernel.sample(surface, choice, draws, groups, light_);
        add_one(traits, paths, surface, groups, radiance, counts);
      });
}

// The light's direction decides on which side of the surface the shadow ray starts.
template <class T>
void DirectLight<T>::add_one(const LightTraits& traits, const PathBatch<T>& paths,
                             const SurfaceBatch<T>& surface, const Groups& groups, Vec3Array<T>& radiance,
                             TraceCounts& counts) {
  const N zero(T(0));
  RayBatch<T>& shadow = light_.shadow;
  for (const int i : groups) pdf_.put(i, zero);
  const Directions<T> directions{paths.rays.direction, shadow.direction, shadow.t_max,
                                 plan_.constant_half && paths.depth == 0 && traits.parallel};
  for (const auto& m : geometry_.materials)
    if (m.traits.lit) m.kernel->evaluate(directions, surface, groups, f_cos_, pdf_);
  Groups reached;
  for (const int i : groups) {
    const auto lit = pdf_.at(i) > zero;
    shadow.t_max.put(i, !lit, N(T(-1)));
    if (!any(lit)) continue;
    reached.add(i);
    const Vec3<N> geometric = surface.geometric.at(i);
    const N step = surface.step.at(i);
    const N side = select(dot(shadow.direction.at(i), geometric) < zero, N(-step), step);
    shadow.origin.put(i, surface.position.at(i) + geometric * side);
  }
  if (plan_.shadows) {
    counts.rays.shadow[static_cast<std::size_t>(paths.depth)] += active_rays(shadow, reached);
    accelerator_.occlude(shadow, reached, counts.accelerator);
  }
  for (const int i : reached) {
    const auto seen = shadow.t_max.at(i) > zero;
    radiance.put(i, seen, radiance.at(i) + light_.incident.at(i) * f_cos_.at(i));
  }
}

template class DirectLight<float>;
template class DirectLight<double>;

}  // namespace orrery
