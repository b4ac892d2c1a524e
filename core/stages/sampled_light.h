#pragma once

#include "core/stages/environment_lighting.h"
#include "core/stages/shadowed_light.h"

namespace orrery {

// Direct light of one sampled light source per surface point: next event estimation, weighted against rays
// that hit the same light (power heuristic). Not thread-safe: each object owns its batches.
template <class T>
class SampledLight {
 public:
  // `drawn` are the lobes whose sampled rays may hit light as well: all, or all but the diffuse ones. The
  // light of other lobes is weighted against their own rays, if there are any. Geometry, accelerator and plan
  // must outlive this object.
  SampledLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan, Lobes drawn);

  // Returns whether diffuse lobes must sample directions of their own. True if they are not in `drawn` and
  // some light is not sampled, at least in part.
  bool wants_diffuse_rays() const { return wants_diffuse_rays_; }

  // Adds the light of one sampled source per surface point to its radiance. `groups` are the registers with a
  // lit material.
  void add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
           const LaneGroups& groups, Vec3Array<T>& radiance, TraceCounts& counts);

  // Adds the radiance emitted by surfaces that were hit, weighted against the samples of add() at the rays'
  // origins.
  void add_emission(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                    const LaneGroups& met, Vec3Array<T>& radiance);

  // Adds the light that rays find which missed, weighted in the same way.
  void add_environment(const PathBatch<T>& paths, const HitBatch<T>& hits, const LaneGroups& groups,
                       Vec3Array<T>& radiance) {
    environment_lighting_.add(paths.rays, hits, groups, paths.depth > 0 ? &paths.pdf : nullptr, radiance);
  }
  // Returns the unweighted environment light, for camera rays.
  EnvironmentLighting<T>& beyond() { return environment_lighting_; }

 private:
  using N = Lanes<T>;
  // Lights of one kernel: a set, the emitters, or the environment.
  struct Source {
    const LightKernel<T>* kernel;
    std::vector<IndexOf<T>> index;  // index in the kernel by light number; -1: another kernel
  };
  void add_sources();
  void choose(const PathDraws<T>& draws, const SurfaceBatch<T>& surface, const LaneGroups& groups);
  // Sets choices_ to the emitters hit by the lanes of `emits` in register i.
  void note_emitters(const RayBatch<T>& rays, const HitBatch<T>& hits, int i, const MaskOf<N>& emits);

  const Geometry<T>& geometry_;
  std::vector<Source> sources_;
  // Lights are numbered: scene lights, emitters, and the environment if it is sampled.
  const LightTree<T>* tree_;  // all lights but the environment; null: no others
  std::size_t count_, first_emitter_;
  bool environment_;  // chosen separately: always without other lights, else half of the time
  T share_;           // probability to choose the environment, and to choose the others
  bool apart_;        // diffuse lobes are not in `drawn`
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
