#pragma once

#include "core/stages/shadowed_light.h"

namespace orrery {

// Light that reaches surfaces straight from one light source each, which is drawn: next event estimation,
// weighted against rays that meet the same light by chance (Veach and Guibas, "Optimally Combining Sampling
// Techniques for Monte Carlo Rendering", SIGGRAPH 1995: the power heuristic with exponent 2). One object
// belongs to one thread: it keeps its batches.
template <class T>
class SampledLight {
 public:
  // Geometry, accelerator and plan outlive it.
  SampledLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan);

  // Adds what the light drawn for each surface point does to its radiance. `groups`: registers with a lane
  // whose material is lit.
  void add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
           const Groups& groups, Vec3Array<T>& radiance, TraceCounts& counts);

  // Adds what the surfaces that were hit send out by themselves, as far as add() did not at the rays'
  // origins.
  void add_emission(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                    const Groups& met, Vec3Array<T>& radiance);

 private:
  using N = Lanes<T>;
  // All of one kernel, or the emitters.
  struct Source {
    const LightKernel<T>* kernel;
    std::vector<IndexOf<T>> index;  // within the kernel, by number of the light; -1: of another kernel
  };
  void choose(const PathDraws<T>& draws, const Groups& groups);
  // Whom the lanes of `emits` of register i hit, as choices_.
  void note_emitters(const HitBatch<T>& hits, int i, const MaskOf<N>& emits);

  const Geometry<T>& geometry_;
  std::vector<Source> sources_;
  // By number of the light: its probability, and the first of the 2^24 random numbers that is beyond its own.
  std::vector<T> probability_;
  std::vector<std::uint32_t> end_;
  std::size_t first_emitter_ = 0;
  Array<IndexOf<T>> chosen_;  // number of the light
  LightChoices<T> choices_;
  ShadowedLight<T> shadowed_;
  Array<T> by_light_;  // density with which lights are drawn where rays hit them by chance
};

extern template class SampledLight<float>;
extern template class SampledLight<double>;

}  // namespace orrery
