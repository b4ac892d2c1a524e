#pragma once

#include <vector>

#include "core/model/light.h"
#include "core/model/path.h"

namespace orrery {

template <class T>
class LightTree;

// Light from infinitely far away, of an environment and of suns, that is seen by rays which meet nothing.
// One object belongs to one thread: it keeps its batches.
template <class T>
class Beyond {
 public:
  // The kernel and the tree outlive this. `choice`: which of its lights, and with which probability light is
  // drawn from it, times that of the choice of `number` from the tree, if there is a tree.
  void see(const LightKernel<T>& kernel, const LightChoice<T>& choice, const LightTree<T>* tree = nullptr,
           std::size_t number = 0) {
    sources_.push_back({&kernel, choice, tree, number});
  }

  bool empty() const { return sources_.empty(); }

  // Adds it to the radiance of the rays of `groups` that met nothing. by_lobe: density with which each ray's
  // direction was drawn, 0 where no light could have been drawn instead; null: so of all.
  void add(const RayBatch<T>& rays, const HitBatch<T>& hits, const Groups& groups, const Array<T>* by_lobe,
           Vec3Array<T>& radiance);

 private:
  using N = Lanes<T>;
  struct Source {
    const LightKernel<T>* kernel;
    LightChoice<T> choice;
    const LightTree<T>* tree;
    std::size_t number;
  };
  // Multiplies by_light_ by the probability of the choice, where it is needed.
  void weigh_choice(const Source& source, const RayBatch<T>& rays, const Groups& missed,
                    const Array<T>& by_lobe);
  std::vector<Source> sources_;
  Vec3Array<T> found_;
  Array<T> by_light_;
};

extern template class Beyond<float>;
extern template class Beyond<double>;

}  // namespace orrery
