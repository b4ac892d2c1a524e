#pragma once

#include "core/lighting/environment_lighting.h"
#include "core/lighting/shadowed_light.h"

namespace orrery {

// Direct light of one sampled light source per surface point: next event estimation, weighted against rays
// that hit the same light (power heuristic). Not thread-safe: each object owns its batches.
template <class T>
class SampledLight {
 public:
  // `drawn`: lobes from which the caller samples rays that may hit the same light: Lobes::all or
  // Lobes::non_diffuse. With Lobes::non_diffuse, light on diffuse lobes is weighted against DiffuseRays if
  // wants_diffuse_rays(). Geometry, accelerator and plan must outlive this object.
  SampledLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan, Lobes drawn);

  // Returns true if the caller must trace DiffuseRays: `drawn` excludes diffuse lobes, and light sampling
  // misses some light.
  bool wants_diffuse_rays() const { return wants_diffuse_rays_; }

  // Adds the light of one sampled source per surface point to its radiance. `groups` are the registers with a
  // lit material.
  void add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
           const LaneGroups& groups, Vec3Array<T>& radiance, TraceCounts& counts);

  // Adds the radiance emitted by surfaces that were hit, weighted against the samples of add() at the rays'
  // origins.
  void add_emission(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                    const LaneGroups& met, Vec3Array<T>& radiance);

  // Adds the environment light to rays that missed, with the same weights.
  void add_environment(const PathBatch<T>& paths, const HitBatch<T>& hits, const LaneGroups& groups,
                       Vec3Array<T>& radiance) {
    environment_lighting_.add(paths.rays, hits, groups, paths.depth > 0 ? &paths.pdf : nullptr, radiance);
  }
  // Returns the environment light, for camera rays, which need no weights.
  EnvironmentLighting<T>& beyond() { return environment_lighting_; }

 private:
  using N = Lanes<T>;
  // Lights of one kernel: a set, the emitters, or the environment.
  struct Source {
    const LightKernel<T>* kernel;
    std::vector<IndexOf<T>> index;  // index in the kernel, by light number; -1: light of another kernel
  };
  void add_sources();
  void choose(const PathDraws<T>& draws, const SurfaceBatch<T>& surface, const LaneGroups& groups);
  // Sets choices_ to the emitters hit in the lanes `emits` of register i, with their selection probabilities.
  void note_emitters(const RayBatch<T>& rays, const HitBatch<T>& hits, int i, const MaskOf<N>& emits);

  const Geometry<T>& geometry_;
  std::vector<Source> sources_;
  // Light numbers: scene lights, then emitters, then the environment if it is sampled.
  const LightTree<T>* tree_;  // all lights except the environment; null if there are none
  std::size_t count_, first_emitter_;
  bool environment_;  // true if sampled: with probability 1/2, or 1 without other lights
  T share_;           // probability of sampling the environment, and of sampling the tree
  bool apart_;        // `drawn` excludes diffuse lobes
  bool wants_diffuse_rays_;
  EnvironmentLighting<T> environment_lighting_;
  Array<IndexOf<T>> chosen_;  // light numbers
  LightChoices<T> choices_;
  ShadowedLight<T> shadowed_;
  Array<T> by_light_;  // density of light sampling at the points that rays hit
};

extern template class SampledLight<float>;
extern template class SampledLight<double>;

}  // namespace orrery
