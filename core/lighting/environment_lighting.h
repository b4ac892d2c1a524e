#pragma once

#include <vector>

#include "core/model/light.h"
#include "core/model/path.h"

namespace orrery {

template <class T>
class LightTree;

// Light of the environment and of suns, for rays that miss everything. Not thread-safe: each object owns its
// batches.
template <class T>
class EnvironmentLighting {
 public:
  // Adds a light source. `choice` is one of the kernel's lights and the probability of sampling it. With a
  // tree, the probability is multiplied by the probability of selecting light `number` from the tree. Kernel
  // and tree must outlive this object.
  void see(const LightKernel<T>& kernel, const LightChoice<T>& choice, const LightTree<T>* tree = nullptr,
           std::size_t number = 0) {
    sources_.push_back({&kernel, choice, tree, number});
  }

  bool empty() const { return sources_.empty(); }

  // Adds the light to the radiance of the rays of `groups` that missed. `by_lobe` is the density per solid
  // angle with which each direction was sampled, or 0 for perfectly specular directions. Null means 0 for all
  // rays. The power heuristic weights light if both `by_lobe` and the density of light sampling are positive.
  // Other light has weight 1.
  void add(const RayBatch<T>& rays, const HitBatch<T>& hits, const LaneGroups& groups,
           const Array<T>* by_lobe, Vec3Array<T>& radiance);

 private:
  using N = Lanes<T>;
  struct Source {
    const LightKernel<T>* kernel;
    LightChoice<T> choice;
    const LightTree<T>* tree;
    std::size_t number;
  };
  // Multiplies by_light_ by the probability of selecting the source from its tree. Skips lanes whose light
  // has weight 1.
  void weigh_choice(const Source& source, const RayBatch<T>& rays, const LaneGroups& missed,
                    const Array<T>& by_lobe);
  std::vector<Source> sources_;
  Vec3Array<T> found_;
  Array<T> by_light_;
};

extern template class EnvironmentLighting<float>;
extern template class EnvironmentLighting<double>;

}  // namespace orrery
