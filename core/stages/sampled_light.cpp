#include "core/stages/sampled_light.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "core/stages/emission.h"
#include "core/stages/power_heuristic.h"

namespace orrery {
namespace {

constexpr std::uint32_t kRandomNumbers = 1u << 24;  // that a light is chosen by

// Shares of `numbers` random numbers: one half evenly, so that no light is forgotten where it is near, and
// one half by power. Returns the first number beyond each light's own.
std::vector<std::uint32_t> ends_of(const std::vector<double>& powers, std::uint32_t numbers) {
  const double sum = std::accumulate(powers.begin(), powers.end(), 0.0);
  const double even = 1 / static_cast<double>(powers.size());
  std::vector<std::uint32_t> ends;
  double end = 0;
  for (const double power : powers) {
    end += sum > 0 ? (even + power / sum) / 2 : even;
    ends.push_back(static_cast<std::uint32_t>(std::min(1.0, end) * numbers + 0.5));
  }
  ends.back() = numbers;
  return ends;
}

}  // namespace

template <class T>
SampledLight<T>::SampledLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator,
                              const Plan& plan)
    : geometry_(geometry), shadowed_(geometry, accelerator, plan) {
  const Scene& scene = *geometry.scene;
  std::vector<double> powers;
  for (const LightPlace& light : scene.lights)
    powers.push_back(max_component(scene.light_sets[light.set]->intensity(light.index)));
  first_emitter_ = powers.size();
  powers.insert(powers.end(), geometry.emitter_powers.begin(), geometry.emitter_powers.end());
  const bool environment = scene.environment && scene.environment->sampled();
  add_sources(powers.size() + environment);
  if (environment) for_environment_ = powers.empty() ? kRandomNumbers : kRandomNumbers / 2;
  if (!powers.empty()) end_ = ends_of(powers, kRandomNumbers - for_environment_);
  std::uint32_t begin = 0;
  for (const std::uint32_t end : end_) {
    probability_.push_back(static_cast<T>((end - begin) / double{kRandomNumbers}));
    begin = end;
  }
  if (environment) probability_.push_back(static_cast<T>(for_environment_ / double{kRandomNumbers}));
  if (geometry.environment) beyond_.see(*geometry.environment, {0, environment ? probability_.back() : T(0)});
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& [set, index] = scene.lights[i];
    const LightSet& lights = *scene.light_sets[set];
    if (lights.extended(index) && lights.traits().parallel)
      beyond_.see(*geometry.lights[set], {index, probability_[i]});
  }
}

template <class T>
void SampledLight<T>::add_sources(std::size_t lights) {
  const Scene& scene = *geometry_.scene;
  const auto add = [&](const LightKernel<T>* kernel) -> std::vector<IndexOf<T>>& {
    return sources_.emplace_back(Source{kernel, std::vector<IndexOf<T>>(lights, -1)}).index;
  };
  for (std::size_t set = 0; set < geometry_.lights.size(); ++set) {
    if (!geometry_.lights[set]) continue;
    std::vector<IndexOf<T>>& index = add(geometry_.lights[set].get());
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      if (scene.lights[i].set == set) index[i] = scene.lights[i].index;
  }
  if (geometry_.emitters) {
    const auto first = add(geometry_.emitters.get()).begin() + static_cast<std::ptrdiff_t>(first_emitter_);
    std::iota(first, first + static_cast<std::ptrdiff_t>(geometry_.emitter_powers.size()), 0);
  }
  if (scene.environment && scene.environment->sampled()) add(geometry_.environment.get()).back() = 0;
}

template <class T>
void SampledLight<T>::choose(const PathDraws<T>& draws, const Groups& groups) {
  if (probability_.size() == 1) {
    for (const int i : groups) {
      chosen_.put(i, IndexLanes<T>(IndexOf<T>{0}));
      choices_.probability.put(i, N(T(1)));
    }
    return;
  }
  for (const int i : groups) {
    const N u = draws.two(SampleSet::light_choice, i).u;
    for (int lane = 0; lane < kWidth<T>; ++lane) {
      const auto number =
          static_cast<std::uint32_t>(double{u[static_cast<std::size_t>(lane)]} * kRandomNumbers);
      const auto light =
          number < for_environment_
              ? std::ssize(end_)
              : std::upper_bound(end_.begin(), end_.end(), number - for_environment_) - end_.begin();
      chosen_[i + lane] = static_cast<IndexOf<T>>(light);
      choices_.probability[i + lane] = probability_[static_cast<std::size_t>(light)];
    }
  }
}

template <class T>
void SampledLight<T>::add(const PathBatch<T>& paths, const PathDraws<T>& draws,
                          const SurfaceBatch<T>& surface, const Groups& groups, Vec3Array<T>& radiance,
                          TraceCounts& counts) {
  if (groups.empty() || probability_.empty()) return;
  choose(draws, groups);
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
    radiance.put(i, light.shadow.t_max.at(i) > zero,
                 radiance.at(i) + light.incident.at(i) * shadowed_.f_cos.at(i) * weight);
  }
}

template <class T>
void SampledLight<T>::add_emission(const PathBatch<T>& paths, const HitBatch<T>& hits,
                                   const SurfaceBatch<T>& surface, const Groups& met,
                                   Vec3Array<T>& radiance) {
  if (geometry_.emission.empty()) return;
  const N zero(T(0)), one(T(1));
  Groups emitting;
  for (const int i : met) {
    const auto emits = max_component(emission_at(geometry_, surface, i)) > zero;
    if (!any(emits)) continue;
    emitting.add(i);
    by_light_.put(i, zero);
    if (paths.depth > 0 && geometry_.emitters) note_emitters(hits, i, emits);
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
void SampledLight<T>::note_emitters(const HitBatch<T>& hits, int i, const MaskOf<N>& emits) {
  for (int lane = i; lane < i + kWidth<T>; ++lane) {
    const bool mine = emits[static_cast<std::size_t>(lane - i)];
    const IndexOf<T> number =
        mine ? geometry_.emitter_of[static_cast<std::size_t>(hits.primitive[lane])] : IndexOf<T>(-1);
    choices_.index[lane] = number;
    choices_.probability[lane] =
        number < 0 ? T(0) : probability_[first_emitter_ + static_cast<std::size_t>(number)];
  }
}

template class SampledLight<float>;
template class SampledLight<double>;

}  // namespace orrery
