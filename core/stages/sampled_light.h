#pragma once

#include "core/stages/beyond.h"
#include "core/stages/shadowed_light.h"

namespace orrery {

// Light that reaches surfaces straight from one light source each, which is drawn: next event estimation,
// weighted against rays that meet the same light by chance (power heuristic). One object belongs to one
// thread: it keeps its batches.
template <class T>
class SampledLight {
 public:
  // Geometry, accelerator and plan outlive it. `drawn`: the lobes by which rays may meet light as well, all
  // or all but the diffuse ones; the light of others is weighted against rays of their own, if there are any.
  SampledLight(const Geometry<T>& geometry, const Accelerator<T>& accelerator, const Plan& plan, Lobes drawn);

  // Whether diffuse lobes have to draw directions of their own, because they are not among those drawn and
  // some light can not be drawn from, or not from all of it.
  bool wants_diffuse_rays() const { return wants_diffuse_rays_; }

  // Adds what the light drawn for each surface point does to its radiance. `groups`: registers with a lane
  // whose material is lit.
  void add(const PathBatch<T>& paths, const PathDraws<T>& draws, const SurfaceBatch<T>& surface,
           const Groups& groups, Vec3Array<T>& radiance, TraceCounts& counts);

  // Adds what the surfaces that were hit send out by themselves, as far as add() did not at the rays'
  // origins.
  void add_emission(const PathBatch<T>& paths, const HitBatch<T>& hits, const SurfaceBatch<T>& surface,
                    const Groups& met, Vec3Array<T>& radiance);

  // Likewise, what rays that met nothing see.
  void add_beyond(const PathBatch<T>& paths, const HitBatch<T>& hits, const Groups& groups,
                  Vec3Array<T>& radiance) {
    beyond_.add(paths.rays, hits, groups, paths.depth > 0 ? &paths.pdf : nullptr, radiance);
  }
  // All of it, for camera rays.
  Beyond<T>& beyond() { return beyond_; }

 private:
  using N = Lanes<T>;
  // All of one kernel, the emitters, or the environment.
  struct Source {
    const LightKernel<T>* kernel;
    std::vector<IndexOf<T>> index;  // within the kernel, by number of the light; -1: of another kernel
  };
  void add_sources();
  void choose(const PathDraws<T>& draws, const SurfaceBatch<T>& surface, const Groups& groups);
  // Whom the lanes of `emits` of register i hit, as choices_.
  void note_emitters(const RayBatch<T>& rays, const HitBatch<T>& hits, int i, const MaskOf<N>& emits);

  const Geometry<T>& geometry_;
  std::vector<Source> sources_;
  // Lights are numbered: those of the scene, the emitters, the environment if light is drawn from it.
  const LightTree<T>* tree_;  // of all but the environment; null: there are no others
  std::size_t count_, first_emitter_;
  bool environment_;  // chosen apart: always if there are no others, half of the time else
  T share_;           // the probability of choosing it, and that of choosing the others
  bool apart_;        // diffuse lobes are not drawn
  bool wants_diffuse_rays_;
  Beyond<T> beyond_;
  Array<IndexOf<T>> chosen_;  // number of the light
  LightChoices<T> choices_;
  ShadowedLight<T> shadowed_;
  Array<T> by_light_;  // density with which lights are drawn where rays hit them by chance
};

extern template class SampledLight<float>;
extern template class SampledLight<double>;

}  // namespace orrery
