#include "core/accelerators/static_and_moving_bvh.h"

#include <algorithm>

#include "core/accelerators/sah_builder.h"
#include "core/accelerators/unbounded.h"

namespace orrery {
namespace {

// Ray registers of a batch, prepared for box tests.
template <class T>
class BoxRays {
 public:
  BoxRays(const RayBatch<T>& rays, const LaneGroups& groups) {
    rays_.reserve(static_cast<std::size_t>(groups.size()));
    for (const int i : groups) {
      place_[static_cast<std::size_t>(i / kWidth<T>)] = static_cast<std::uint16_t>(rays_.size());
      rays_.emplace_back(rays.origin.at(i), rays.direction.at(i));
    }
  }
  const BoxRay<Lanes<T>>& operator[](int i) const {
    return rays_[place_[static_cast<std::size_t>(i / kWidth<T>)]];
  }

 private:
  std::vector<BoxRay<Lanes<T>>> rays_;
  std::array<std::uint16_t, kBatch / kWidth<T>> place_;
};

template <class T>
class StaticAndMovingBvh final : public Accelerator<T> {
 public:
  StaticAndMovingBvh(const PrimitiveList<T>& primitives) {
    for (const auto& primitive : primitives)
      (primitive.kernel->timed() ? moving_ : resting_).push_back(primitive);
    unbounded_ = std::make_unique<Unbounded<T>>(moving_);
    tree_ = SahBuilder<T>::build(items_of(moving_));
  }
  void build_resting(const AcceleratorType& type, const Accelerator<T>* before) {
    if (resting_.empty()) return;
    const auto* other = dynamic_cast<const StaticAndMovingBvh*>(before);
    if (other && other->resting_.size() == resting_.size()) behind_ = other->behind_->refitted(resting_);
    if (!behind_) behind_ = build(type, resting_);
  }

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    if (behind_) behind_->closest(rays, groups, hits, counts);
    unbounded_->closest(rays, groups, hits, counts);
    if (!tree_.empty()) find(0, groups, BoxRays<T>(rays, groups), rays, hits, counts);
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    if (behind_) behind_->occlude(rays, groups, counts);
    const LaneGroups open = unbounded_->occlude(rays, with_active_rays(rays, groups), counts);
    if (!tree_.empty() && !open.empty()) cover(0, open, BoxRays<T>(rays, open), rays, counts);
  }

  AcceleratorFacts facts() const override {
    AcceleratorFacts facts = behind_ ? behind_->facts() : AcceleratorFacts{};
    facts.bytes += tree_.nodes.size() * sizeof(tree_.nodes[0]) + tree_.items.size() * sizeof(tree_.items[0]);
    facts.references += moving_.size();
    return facts;
  }

 private:
  using N = Lanes<T>;
  using Node = typename BoxTree<T>::Node;

  // Returns the registers in which at least one ray enters the node's box. `ends` contains the far end of
  // each ray: t_max or the distance of its nearest known hit.
  static LaneGroups entering(const Node& node, const LaneGroups& groups, const BoxRays<T>& boxes,
                             const Array<T>& ends, AcceleratorCounts& counts) {
    LaneGroups in;
    ++counts.node_visits;
    for (const int i : groups) {
      const N end = ends.at(i);
      counts.box_tests += static_cast<std::uint64_t>(stdx::popcount(end > N(T(0))));
      if (any(enters(boxes[i], Vec3<N>(node.box.lo), Vec3<N>(node.box.hi), end))) in.add(i);
    }
    return in;
  }

  // Finds the closest hits in the subtree of node `at`. Visits the child first whose centre is nearer along
  // the direction of the first ray.
  void find(std::uint32_t at, const LaneGroups& groups, const BoxRays<T>& boxes, const RayBatch<T>& rays,
            HitBatch<T>& hits, AcceleratorCounts& counts) const {
    const Node& node = tree_.nodes[at];
    const LaneGroups in = entering(node, groups, boxes, hits.t, counts);
    if (in.empty()) return;
    if (node.leaf) {
      for (std::uint32_t i = node.left; i < node.right; ++i) {
        const auto& primitive = moving_[tree_.items[i].primitive];
        counts.primitive_tests += active_rays(rays, in);
        primitive.kernel->closest(primitive.index, rays, in, hits, counts);
      }
      return;
    }
    const auto& left = tree_.nodes[node.left].box;
    const auto& right = tree_.nodes[node.right].box;
    const bool right_first =
        dot((left.lo + left.hi) - (right.lo + right.hi), rays.direction[*in.begin()]) > T(0);
    find(right_first ? node.right : node.left, in, boxes, rays, hits, counts);
    find(right_first ? node.left : node.right, in, boxes, rays, hits, counts);
  }

  // Sets t_max to -1 for rays that hit a primitive in the subtree of node `at`.
  void cover(std::uint32_t at, const LaneGroups& groups, const BoxRays<T>& boxes, RayBatch<T>& rays,
             AcceleratorCounts& counts) const {
    const Node& node = tree_.nodes[at];
    LaneGroups in = entering(node, groups, boxes, rays.t_max, counts);
    if (in.empty()) return;
    if (!node.leaf) {
      cover(node.left, in, boxes, rays, counts);
      return cover(node.right, in, boxes, rays, counts);
    }
    for (std::uint32_t i = node.left; i < node.right && !in.empty(); ++i) {
      const auto& primitive = moving_[tree_.items[i].primitive];
      counts.primitive_tests += active_rays(rays, in);
      primitive.kernel->occlude(primitive.index, rays, in, counts);
      in = with_active_rays(rays, in);
    }
  }

  PrimitiveList<T> resting_, moving_;
  AcceleratorPtr<T> behind_;  // null if all primitives are timed
  std::unique_ptr<Unbounded<T>> unbounded_;
  BoxTree<T> tree_;
};

}  // namespace

template <class T>
bool any_timed(const PrimitiveList<T>& primitives) {
  const ShapeKernel<T>* last = nullptr;  // primitives of one kernel are mostly adjacent
  return std::any_of(primitives.begin(), primitives.end(), [&last](const Primitive<T>& primitive) {
    if (primitive.kernel == last) return false;
    last = primitive.kernel;
    return last->timed();
  });
}

template <class T>
AcceleratorPtr<T> build_static_and_moving(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                          const Accelerator<T>* before) {
  auto accelerator = std::make_unique<StaticAndMovingBvh<T>>(primitives);
  accelerator->build_resting(type, before);
  return accelerator;
}

template bool any_timed(const PrimitiveList<float>&);
template bool any_timed(const PrimitiveList<double>&);
template AcceleratorPtr<float> build_static_and_moving(const AcceleratorType&, const PrimitiveList<float>&,
                                                       const Accelerator<float>*);
template AcceleratorPtr<double> build_static_and_moving(const AcceleratorType&, const PrimitiveList<double>&,
                                                        const Accelerator<double>*);

}  // namespace orrery
