#pragma once

#include "core/accelerators/batch_traversal.h"
#include "core/accelerators/unbounded.h"

namespace orrery {

// Bounding volume hierarchy: a WideTree converted from the BoxTree that Builder::build() returns. Unbounded
// primitives are not in the tree, and every ray tests all of them.
template <class T, class Builder>
class Hierarchy final : public Accelerator<T> {
 public:
  explicit Hierarchy(const PrimitiveList<T>& primitives)
      : unbounded_(primitives), tree_(Builder::build(items_of(primitives)), primitives) {}

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    unbounded_.closest(rays, groups, hits, counts);
    if (tree_.empty()) return;
    BatchTraversal<T>(tree_, rays, groups, hits.t, &hits.primitive).template run<Query::closest>(counts);
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    const LaneGroups open = unbounded_.occlude(rays, groups, counts);
    if (tree_.empty()) return;
    BatchTraversal<T>(tree_, rays, open, rays.t_max, nullptr).template run<Query::occlude>(counts);
  }

  AcceleratorFacts facts() const override {
    return {.bytes = tree_.bytes() + unbounded_.bytes(),
            .depth = tree_.depth(),
            .references = tree_.blocks().references() + unbounded_.size(),
            .refitted = refitted_,
            .surface_area_growth = tree_.surface_area_growth()};
  }

  AcceleratorPtr<T> refitted(const PrimitiveList<T>& moved) const override {
    auto next = std::make_unique<Hierarchy>(*this);
    next->unbounded_ = Unbounded<T>(moved);
    if (!tree_.empty()) next->tree_.follow(moved);
    next->refitted_ = true;
    if (!(next->tree_.surface_area_growth() <= kMaxSurfaceAreaGrowth)) return nullptr;
    return next;
  }

 private:
  Unbounded<T> unbounded_;
  WideTree<T> tree_;
  bool refitted_ = false;
};

}  // namespace orrery
