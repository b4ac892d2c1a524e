#include "core/accelerators/oriented_box.h"
#include "core/base/task_scope.h"

namespace orrery {
namespace {

// List of primitives. Each bounded primitive has an axis-aligned box, and an oriented box if it is much
// smaller.
template <class T>
class PerPrimitiveObb {
 public:
  explicit PerPrimitiveObb(const PrimitiveList<T>& primitives) {
    for (std::uint32_t i = 0; i < primitives.size(); ++i)
      if (primitives[i].bounds.bounded()) add(primitives, i);
    blocks_.pack();
  }

  bool empty() const { return boxed_.empty(); }
  AcceleratorFacts facts() const {
    return {
        .bytes = boxed_.size() * sizeof(Boxed) + oriented_.size() * sizeof(OrientedBox<T>) + blocks_.bytes(),
        .depth = 1,
        .references = blocks_.references()};
  }

  template <Query kQuery>
  void traverse(TraversalState<T>& state) const {
    for (const Boxed& boxed : boxed_) {
      T from(0), to = state.hit.t;
      if (to < 0) return;
      ++state.counts.box_tests;
      if (!state.probe.clip(boxed.box, from, to)) continue;
      if (boxed.oriented != kNone) {
        ++state.counts.box_tests;
        if (!oriented_[boxed.oriented].clip(state.ray.ray, from, to)) continue;
      }
      state.template meet<kQuery>(blocks_, std::span(&boxed.block, 1));
    }
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  struct Boxed {
    Bounds<T> box;
    std::uint32_t oriented;  // index, or kNone
    BlockName block;
  };

  void add(const PrimitiveList<T>& primitives, std::uint32_t place) {
    checkpoint();
    const auto hull = hull_of(primitives[place]);
    SurfaceMoments moments;
    for (const auto& triangle : hull) moments.add(triangle);
    const auto oriented = OrientedBox<T>::around(principal_axes(moments), hull);
    Boxed boxed{padded<T>(primitives[place].bounds), kNone, blocks_.add(primitives, std::span(&place, 1))};
    if (oriented_pays(oriented, boxed.box)) {
      boxed.oriented = static_cast<std::uint32_t>(oriented_.size());
      oriented_.push_back(oriented);
    }
    boxed_.push_back(boxed);
  }

  std::vector<Boxed> boxed_;
  std::vector<OrientedBox<T>> oriented_;
  Blocks<T> blocks_;
};

template <class T>
using OrientedBoxes = SingleRayAccelerator<T, PerPrimitiveObb<T>>;

}  // namespace

AcceleratorType oriented_boxes_type() {
  return {"oriented-boxes",
          "List of primitives. Rays test the oriented box of each primitive first.",
          {.ray = 24, .visit = 0, .box = 2.8, .primitive = 0, .each = 2.8},
          build_accelerator<OrientedBoxes, float>,
          build_accelerator<OrientedBoxes, double>};
}

}  // namespace orrery
