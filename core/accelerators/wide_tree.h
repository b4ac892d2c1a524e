#pragma once

#include <algorithm>

#include "core/accelerators/box_tree.h"
#include "core/accelerators/probes.h"

namespace orrery {

// A tree of boxes whose nodes have up to kBlock<T> children, which are tested at once, over primitives packed
// in blocks. Rays that run alike walk together, others alone.
template <class T>
class WideTree {
 public:
  WideTree(const BoxTree<T>& tree, const PrimitiveList<T>& primitives) {
    if (tree.empty()) return;
    Making making{tree, primitives, {}, {}, {}};
    root_ = convert(making, 0);
    for (std::size_t k = 0; k < making.kernels.size(); ++k) {
      packs_.push_back({blocks_, making.kernels[k]->pack(making.indices[k])});
      blocks_ += static_cast<std::uint32_t>(making.indices[k].size() / kB);
    }
    for (const auto& [node, child, kernel] : making.leaves)
      (node < 0 ? root_ : nodes_[static_cast<std::size_t>(node)].child[child]) += packs_[kernel].first;
  }

  void closest(const RayBatch<T>& rays, int group, HitBatch<T>& hits, AcceleratorCounts& counts) const {
    const Ray<N> ray = rays.at(group);
    const auto active = hits.t.at(group) > N(T(0));
    if (blocks_ == 0 || !any(active)) return;
    const BeamProbe<T> beam(ray, active);
    if (beam.narrow()) {
      const auto rays_together = static_cast<std::uint64_t>(stdx::popcount(active));
      const auto limit = [&] { return stdx::hmax(hits.t.at(group)); };
      walk<true>(beam, limit(), counts, [&](const Packed& pack, std::uint32_t first, std::uint32_t last, T) {
        counts.primitive_tests +=
            rays_together * static_cast<std::uint64_t>(pack.closest(first, last, rays, group, hits));
        return limit();
      });
      return;
    }
    const LoneRays<T> lone(ray);
    for (unsigned bits = bits_of(active); bits != 0; bits &= bits - 1) {
      const int lane = std::countr_zero(bits);
      closest_alone(lone[lane], group + lane, hits, counts);
    }
  }

  void occlude(RayBatch<T>& rays, int group, AcceleratorCounts& counts) const {
    const Ray<N> ray = rays.at(group);
    const auto active = rays.t_max.at(group) > N(T(0));
    if (blocks_ == 0 || !any(active)) return;
    const BeamProbe<T> beam(ray, active);
    if (beam.narrow()) {
      const auto limit = [&] { return stdx::hmax(rays.t_max.at(group)); };
      walk<false>(beam, limit(), counts, [&](const Packed& pack, std::uint32_t first, std::uint32_t last, T) {
        const int together = stdx::popcount(rays.t_max.at(group) > N(T(0)));
        counts.primitive_tests +=
            static_cast<std::uint64_t>(together * pack.occlude(first, last, rays, group));
        return limit();
      });
      return;
    }
    const LoneRays<T> lone(ray);
    for (unsigned bits = bits_of(active); bits != 0; bits &= bits - 1) {
      const int lane = std::countr_zero(bits);
      occlude_alone(lone[lane], rays.t_max[group + lane], counts);
    }
  }

 private:
  using N = Lanes<T>;
  using B = FanLanes<T>;
  using Packed = PackedPrimitives<T>;
  static constexpr std::size_t kW = static_cast<std::size_t>(kFan<T>);
  static constexpr std::size_t kB = static_cast<std::size_t>(kBlock<T>);
  // A child is a node, or a stretch of blocks: kLeaf | blocks - 1 (3 bits) | first block.
  static constexpr std::uint32_t kLeaf = 0x80000000u, kBlockBits = 28, kBlockMask = (1u << kBlockBits) - 1;
  static_assert(SahBuilder<T>::kMostInLeaf <= 8 * kBlock<T>);

  struct Node {
    BoxPlanes<T> planes;  // of places without a child: inside out, so that nothing enters
    std::array<std::uint32_t, kW> child;
  };
  struct Pack {
    std::uint32_t first;  // its first block
    PackedPrimitivesPtr<T> primitives;
  };
  // What only building needs.
  struct Making {
    const BoxTree<T>& tree;
    const PrimitiveList<T>& primitives;
    std::vector<const ShapeKernel<T>*> kernels;
    std::vector<std::vector<int>> indices;  // by kernel
    struct Leaf {
      int node;  // -1: the root
      std::size_t child, kernel;
    };
    std::vector<Leaf> leaves;
  };

  std::uint32_t convert(Making& making, std::uint32_t at, int parent = -1, std::size_t place = 0) {
    const auto& node = making.tree.nodes[at];
    if (node.leaf) return add_leaf(making, node, parent, place);
    const std::vector<std::uint32_t> children = children_of(making.tree, at);
    const std::size_t me = nodes_.size();
    nodes_.emplace_back();
    nodes_[me].planes.fill(B(std::numeric_limits<T>::infinity()));
    for (std::size_t side = 1; side < 6; side += 2)
      nodes_[me].planes[side] = B(-std::numeric_limits<T>::infinity());
    nodes_[me].child.fill(kLeaf);
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Bounds<T>& box = making.tree.nodes[children[i]].box;
      const std::array<T, 6> sides{box.lo.x, box.hi.x, box.lo.y, box.hi.y, box.lo.z, box.hi.z};
      for (std::size_t side = 0; side < 6; ++side) nodes_[me].planes[side][i] = sides[side];
      const std::uint32_t child = convert(making, children[i], static_cast<int>(me), i);
      nodes_[me].child[i] = child;
    }
    return static_cast<std::uint32_t>(me);
  }

  // The largest descendants that make a full node.
  static std::vector<std::uint32_t> children_of(const BoxTree<T>& tree, std::uint32_t at) {
    std::vector<std::uint32_t> children{tree.nodes[at].left, tree.nodes[at].right};
    while (children.size() < kW) {
      const auto size = [&](std::uint32_t n) {
        return tree.nodes[n].leaf ? T(-1) : half_area(tree.nodes[n].box);
      };
      const auto largest = std::max_element(children.begin(), children.end(),
                                            [&](auto a, auto b) { return size(a) < size(b); });
      if (size(*largest) < 0) break;
      const auto& opened = tree.nodes[*largest];
      *largest = opened.left;
      children.push_back(opened.right);
    }
    return children;
  }

  std::uint32_t add_leaf(Making& making, const typename BoxTree<T>::Node& leaf, int parent,
                         std::size_t place) {
    const auto primitive = [&](std::uint32_t item) -> const Primitive<T>& {
      return making.primitives[making.tree.items[item].primitive];
    };
    const auto* kernel = primitive(leaf.left).kernel;
    const auto found = std::find(making.kernels.begin(), making.kernels.end(), kernel);
    const auto k = static_cast<std::size_t>(found - making.kernels.begin());
    if (found == making.kernels.end()) {
      making.kernels.push_back(kernel);
      making.indices.emplace_back();
    }
    std::vector<int>& indices = making.indices[k];
    const auto first = static_cast<std::uint32_t>(indices.size() / kB);
    for (std::uint32_t i = leaf.left; i < leaf.right; ++i) indices.push_back(primitive(i).index);
    indices.resize((indices.size() + kB - 1) / kB * kB, kNothing);
    const auto blocks = static_cast<std::uint32_t>(indices.size() / kB) - first;
    making.leaves.push_back({parent, place, k});
    return kLeaf | (blocks - 1) << kBlockBits | first;
  }

  const Packed& pack_of(std::uint32_t& first) const {
    std::size_t k = 0;
    while (k + 1 < packs_.size() && first >= packs_[k + 1].first) ++k;
    first -= packs_[k].first;
    return *packs_[k].primitives;
  }

  void closest_alone(const LoneRay<T>& ray, int i, HitBatch<T>& hits, AcceleratorCounts& counts) const {
    LoneHit<T> hit{hits.t[i], hits.primitive[i]};
    walk<true>(RayProbe<T>(ray), hit.t, counts,
               [&](const Packed& pack, std::uint32_t first, std::uint32_t last, T) {
                 counts.primitive_tests += static_cast<std::uint64_t>(pack.closest(first, last, ray, hit));
                 return hit.t;
               });
    hits.t[i] = hit.t;
    hits.primitive[i] = hit.primitive;
  }

  void occlude_alone(const LoneRay<T>& ray, T& t_max, AcceleratorCounts& counts) const {
    walk<false>(RayProbe<T>(ray), t_max, counts,
                [&](const Packed& pack, std::uint32_t first, std::uint32_t last, T) {
                  counts.primitive_tests += static_cast<std::uint64_t>(pack.occlude(first, last, ray, t_max));
                  return t_max;
                });
  }

  struct Waiting {
    std::uint32_t child;
    T near;
  };
  static constexpr std::size_t kStack = 96 * kW;  // more than the deepest tree of the builders can fill

  // Opens all that `probe` enters no farther than `limit`, in the order of distance if that matters; `visit`
  // is called with leaves and returns the limit from then on, negative to end.
  template <bool kInOrder, class Probe, class Visit>
  [[gnu::always_inline]] void walk(const Probe& probe, T limit, AcceleratorCounts& counts,
                                   const Visit& visit) const {
    std::array<Waiting, kStack> stack;
    std::size_t top = 0;
    std::uint32_t at = root_;
    std::uint64_t visits = 0;
    for (;;) {
      if ((at & kLeaf) == 0) {
        ++visits;
        B near;
        const Node& node = nodes_[at];
        unsigned entered = probe.enter(node.planes, limit, near);
        if (entered != 0) {
          at = choose<kInOrder>(node, entered, near, stack, top);
          continue;
        }
      } else {
        std::uint32_t first = at & kBlockMask;
        const std::uint32_t blocks = (at >> kBlockBits & 7u) + 1;
        const Packed& pack = pack_of(first);
        limit = visit(pack, first, first + blocks, limit);
        if (limit < 0) break;
      }
      do {
        if (top == 0) {
          counts.node_visits += visits;
          counts.box_tests += visits * kW;
          return;
        }
        --top;
      } while (kInOrder && stack[top].near > limit * kFarther<T>);
      at = stack[top].child;
    }
    counts.node_visits += visits;
    counts.box_tests += visits * kW;
  }

  // The child to go on with; the others wait, nearer ones on top.
  template <bool kInOrder>
  [[gnu::always_inline]] static std::uint32_t choose(const Node& node, unsigned entered, const B& near,
                                                     std::array<Waiting, kStack>& stack, std::size_t& top) {
    alignas(64) std::array<T, kW> distance;
    near.copy_to(distance.data(), stdx::vector_aligned);
    const auto take = [&] {
      const auto i = static_cast<std::size_t>(std::countr_zero(entered));
      entered &= entered - 1;
      return Waiting{node.child[i], distance[i]};
    };
    Waiting next = take();
    const std::size_t bottom = top;
    while (entered != 0) {
      Waiting other = take();
      if constexpr (kInOrder) {
        if (other.near < next.near) std::swap(other, next);
        std::size_t place = top++;
        for (; place > bottom && stack[place - 1].near < other.near; --place) stack[place] = stack[place - 1];
        stack[place] = other;
      } else {
        stack[top++] = other;
      }
    }
    return next.child;
  }

  std::uint32_t root_ = 0, blocks_ = 0;
  std::vector<Node> nodes_;
  std::vector<Pack> packs_;
};

}  // namespace orrery
