#pragma once

#include <vector>

#include "core/model/light.h"
#include "core/model/path.h"

namespace orrery {

template <class T>
class LightTree;

// Light from infinite distance, from the environment and from suns, for rays that miss everything. Not
// thread-safe: each object owns its batches.
template <class T>
class EnvironmentLighting {
 public:
  // Adds a light source. `choice` is one of the kernel's lights and the probability with which it is sampled.
  // With a tree, the probability is multiplied by that of choosing `number` from the tree. Kernel and tree
  // must outlive this object.
  void see(const LightKernel<T>& kernel, const LightChoice<T>& choice, const LightTree<T>* tree = nullptr,
           std::size_t number = 0) {
    sources_.push_back({&kernel, choice, tree, number});
  }

  bool empty() const { return sources_.empty(); }

  // Adds the light to the radiance of rays of `groups` that missed. `by_lobe` is the density with which each
  // direction was sampled, or 0 if no light could have been sampled instead. Null means 0 for all rays.
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
  // Multiplies by_light_ by the probability of the choice from the tree, for the lanes that need it.
  void weigh_choice(const Source& source, const RayBatch<T>& rays, const LaneGroups& missed,
                    const Array<T>& by_lobe);
  std::vector<Source> sources_;
  Vec3Array<T> found_;
  Array<T> by_light_;
};

extern template class EnvironmentLighting<float>;
extern template class EnvironmentLighting<double>;

}  // namespace orrery
