#pragma once

#include "core/accelerators/blocks.h"
#include "core/accelerators/box_testers.h"
#include "core/accelerators/unbounded.h"

namespace orrery {

// State of one ray in a traversal.
template <class T>
struct TraversalState {
  SingleRay<T> ray;
  RayBoxTester<T> probe;
  SingleHit<T> hit;
  AcceleratorCounts& counts;

  // Returns whether a hit at distance `from` or farther can replace the current hit. False for occluded rays,
  // whose t is -1.
  bool open(T from) const { return from <= hit.t * kFarther<T>; }

  template <Query kQuery>
  void meet(const Blocks<T>& blocks, std::span<const BlockName> names) {
    for (const BlockName name : names) {
      const RayBlockPair pair{Blocks<T>::block_of(name), 0};
      const auto& pack = blocks.pack_of(name);
      if constexpr (kQuery == Query::closest)
        pack.closest(std::span(&pair, 1), &ray, &hit, counts);
      else
        pack.occlude(std::span(&pair, 1), &ray, &hit, counts);
    }
  }
};

// Structure that rays traverse one by one. Tree is built from a PrimitiveList and has
//   template <Query> void traverse(TraversalState<T>&) const;   traces one ray through the tree
//   bool empty() const; AcceleratorFacts facts() const;
// Every ray tests all unbounded primitives.
template <class T, class Tree>
class SingleRayAccelerator final : public Accelerator<T> {
 public:
  explicit SingleRayAccelerator(const PrimitiveList<T>& primitives)
      : unbounded_(primitives), tree_(primitives) {}

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    unbounded_.closest(rays, groups, hits, counts);
    for_each_active(groups, hits.t, [&](int i) {
      TraversalState<T> state = begin(rays, i, {hits.t[i], hits.primitive[i]}, counts);
      tree_.template traverse<Query::closest>(state);
      hits.t[i] = state.hit.t;
      hits.primitive[i] = state.hit.primitive;
    });
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const LaneGroups open = unbounded_.occlude(rays, groups, counts);
    for_each_active(open, rays.t_max, [&](int i) {
      TraversalState<T> state = begin(rays, i, {rays.t_max[i], kNoPrimitive}, counts);
      tree_.template traverse<Query::occlude>(state);
      rays.t_max[i] = state.hit.t;
    });
  }

  AcceleratorFacts facts() const override {
    AcceleratorFacts facts = tree_.facts();
    facts.bytes += unbounded_.bytes();
    facts.references += unbounded_.size();
    return facts;
  }

 private:
  template <class Visit>
  void for_each_active(const LaneGroups& groups, const Array<T>& t, const Visit& visit) const {
    if (tree_.empty()) return;
    for (const int group : groups)
      for (int i = group; i < group + kWidth<T>; ++i)
        if (t[i] > 0) visit(i);
  }

  static TraversalState<T> begin(const RayBatch<T>& rays, int i, const SingleHit<T>& hit,
                                 AcceleratorCounts& counts) {
    const Ray<T> ray = rays[i];
    return {SingleRay<T>::of(ray), RayBoxTester<T>(ray), hit, counts};
  }

  Unbounded<T> unbounded_;
  Tree tree_;
};

}  // namespace orrery
