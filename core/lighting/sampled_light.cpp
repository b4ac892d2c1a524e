#include "core/lighting/sampled_light.h"

#include <numeric>

#include "core/lighting/emission.h"
#include "core/lighting/light_tree.h"
#include "core/lighting/power_heuristic.h"

namespace orrery {
namespace {

// Returns whether rays may hit light that is not sampled: an environment, a background or emitting surfaces.
// Environment maps are sampled only in bright regions.
template <class T>
bool has_unsampled_light(const Geometry<T>& geometry) {
  return geometry.environment || geometry.background != Vec3<T>() || geometry.emits_undrawn;
}

}  // namespace

template <class T>
SampledLight<T>::SampledLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator,
                              const Plan& plan, Lobes drawn)
    : geometry_(geometry),
      tree_(geometry.light_tree.get()),
      first_emitter_(geometry.scene->lights.size()),
      apart_(!with_diffuse(drawn)),
      wants_diffuse_rays_(apart_ && has_unsampled_light(geometry)),
      shadowed_(geometry, accelerator, plan, apart_) {
  const Scene& scene = *geometry.scene;
  environment_ = scene.environment && scene.environment->sampled();
  count_ = (tree_ ? tree_->size() : 0) + environment_;
  add_sources();
  share_ = environment_ && tree_ ? T(0.5) : T(1);
  if (geometry.environment)
    environment_lighting_.see(*geometry.environment, {0, environment_ ? share_ : T(0)});
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& [set, index] = scene.lights[i];
    const LightSet& lights = *scene.light_sets[set];
    if (lights.extended(index) && lights.traits().parallel)
      environment_lighting_.see(*geometry.lights[set], {index, share_}, tree_, i);
  }
}

template <class T>
void SampledLight<T>::add_sources() {
  const Scene& scene = *geometry_.scene;
  const auto add = [&](const LightKernel<T>* kernel) -> std::vector<IndexOf<T>>& {
    return sources_.emplace_back(Source{kernel, std::vector<IndexOf<T>>(count_, -1)}).index;
  };
  for (std::size_t set = 0; set < geometry_.lights.size(); ++set) {
    if (!geometry_.lights[set]) continue;
    std::vector<IndexOf<T>>& index = add(geometry_.lights[set].get());
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      if (scene.lights[i].set == set) index[i] = scene.lights[i].index;
  }
  if (geometry_.emitters) {
    std::vector<IndexOf<T>>& index = add(geometry_.emitters.get());
    std::iota(index.begin() + static_cast<std::ptrdiff_t>(first_emitter_),
              index.begin() + static_cast<std::ptrdiff_t>(tree_->size()), 0);
  }
  if (environment_) add(geometry_.environment.get()).back() = 0;
}

// Extends the first random number by the bits of the second, because a light among many may have a
// probability below 2^-24.
template <class T>
void SampledLight<T>::choose(const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
                             const LaneGroups& groups) {
  if (count_ == 1) {
    for (const int i : groups) {
      chosen_.put(i, IndexLanes<T>(IndexOf<T>{0}));
      choices_.probability.put(i, N(T(1)));
    }
    return;
  }
  for (const int i : groups) {
    const auto point = draws.two(SampleSet::light_choice, i);
    std::array<double, LightTree<T>::kPoints> u, of_others;
    for (std::size_t k = 0; k < u.size(); ++k) {
      u[k] = double{point.u[k]} + double{point.v[k]} * 0x1p-24;
      of_others[k] = !environment_ ? u[k] : u[k] < 0.5 ? 0 : 2 * u[k] - 1;
    }
    const auto choices = tree_->choose(surface.position.at(i), of_others);
    for (std::size_t k = 0; k < u.size(); ++k) {
      const bool other = !environment_ || u[k] >= 0.5;
      const int lane = i + static_cast<int>(k);
      chosen_[lane] = static_cast<IndexOf<T>>(other ? choices.light[k] : count_ - 1);
      choices_.probability[lane] = (other ? choices.probability[k] : T(1)) * share_;
    }
  }
}

template <class T>
void SampledLight<T>::add(const PathBatch<T>& paths, const PathDraws<T>& draws,
                          const SurfaceBatch<T>& surface, const LaneGroups& groups, Vec3Array<T>& radiance,
                          TraceCounts& counts) {
  if (groups.empty() || count_ == 0) return;
  choose(draws, surface, groups);
  for (const Source& source : sources_) {
    for (const int i : groups)
      for (int lane = i; lane < i + kWidth<T>; ++lane)
        choices_.index[lane] = source.index[static_cast<std::size_t>(chosen_[lane])];
    source.kernel->sample_each(surface, choices_, draws, groups, shadowed_.light);
  }
  const N zero(T(0)), one(T(1));
  for (const int i : shadowed_.find(paths, surface, groups, false, counts)) {
    const LightBatch<T>& light = shadowed_.light;
    const N by_light = light.pdf.at(i);
    const N weight = select(by_light > zero, power_heuristic(by_light, shadowed_.pdf.at(i)), one);
    Vec3<N> found = light.incident.at(i) * shadowed_.pi_bsdf_cos.at(i) * weight;
    if (apart_) {
      const N by_diffuse = wants_diffuse_rays_ ? shadowed_.diffuse_pdf.at(i) : zero;
      found = found + light.incident.at(i) * shadowed_.diffuse.at(i) *
                          select(by_light > zero, power_heuristic(by_light, by_diffuse), one);
    }
    radiance.put(i, light.shadow.t_max.at(i) > zero, radiance.at(i) + found);
  }
}

template <class T>
void SampledLight<T>::add_emission(const PathBatch<T>& paths, const HitBatch<T>& hits,
                                   const SurfaceBatch<T>& surface, const LaneGroups& met,
                                   Vec3Array<T>& radiance) {
  if (geometry_.emission.empty()) return;
  const N zero(T(0)), one(T(1));
  LaneGroups emitting;
  for (const int i : met) {
    const auto emits = max_component(emission_at(geometry_, surface, i)) > zero;
    if (!any(emits)) continue;
    emitting.add(i);
    by_light_.put(i, zero);
    if (paths.depth > 0 && geometry_.emitters) note_emitters(paths.rays, hits, i, emits);
  }
  if (paths.depth > 0 && geometry_.emitters)
    geometry_.emitters->pdf(paths.rays, hits, choices_, emitting, by_light_);
  for (const int i : emitting) {
    const N by_lobe = paths.pdf.at(i), by_light = by_light_.at(i);
    const N weight = select(by_lobe > zero && by_light > zero, power_heuristic(by_lobe, by_light), one);
    radiance.put(i, radiance.at(i) + emission_at(geometry_, surface, i) * weight);
  }
}

template <class T>
void SampledLight<T>::note_emitters(const RayBatch<T>& rays, const HitBatch<T>& hits, int i,
                                    const MaskOf<N>& emits) {
  for (int lane = i; lane < i + kWidth<T>; ++lane) {
    const bool mine = emits[static_cast<std::size_t>(lane - i)];
    const IndexOf<T> number =
        mine ? geometry_.emitter_of[static_cast<std::size_t>(hits.primitive[lane])] : IndexOf<T>(-1);
    choices_.index[lane] = number;
    if (number < 0) continue;
    const std::size_t light = first_emitter_ + static_cast<std::size_t>(number);
    choices_.probability[lane] = tree_->probability(rays.origin[lane], light) * share_;
  }
}

template class SampledLight<float>;
template class SampledLight<double>;

}  // namespace orrery
