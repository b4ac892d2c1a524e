#pragma once

#include <algorithm>

#include "core/accelerators/box_tree.h"
#include "core/accelerators/probes.h"

namespace orrery {

// A tree of boxes whose nodes have up to kFan<T> children, over primitives packed in blocks.
template <class T>
class WideTree {
 public:
  // A node, or a block of primitives: kLeaf, which pack (5 bits), which block of it (26 bits).
  using Child = std::uint32_t;

  struct Node {
    BoxPlanes<T> planes;  // of places without a child: inside out, so that nothing enters
    std::array<Child, static_cast<std::size_t>(kFan<T>)> child;
  };

  WideTree(const BoxTree<T>& tree, const PrimitiveList<T>& primitives) {
    if (tree.empty()) return;
    std::vector<Making> packs;
    root_ = convert(tree, 0, primitives, packs, 1);
    nodes_.shrink_to_fit();
    for (const Making& pack : packs) packs_.push_back(pack.kernel->pack(pack.indices));
  }

  bool empty() const { return packs_.empty(); }
  int depth() const { return depth_; }
  std::size_t bytes() const {
    std::size_t bytes = nodes_.size() * sizeof(Node);
    for (const auto& pack : packs_) bytes += pack->bytes();
    return bytes;
  }
  Child root() const { return root_; }
  const Node& node(Child child) const { return nodes_[child]; }

  static bool is_leaf(Child child) { return (child & kLeaf) != 0; }
  static std::uint32_t block_of(Child leaf) { return leaf & kBlockMask; }
  const PackedPrimitives<T>& pack_of(Child leaf) const { return *packs_[pack_number(leaf)]; }
  static bool same_pack(Child a, Child b) { return pack_number(a) == pack_number(b); }

 private:
  static constexpr std::size_t kBlockSize = static_cast<std::size_t>(kBlock<T>);
  static constexpr Child kLeaf = 0x80000000u, kBlockMask = 0x03ffffffu;
  static constexpr int kBlockBits = 26;
  static std::size_t pack_number(Child leaf) { return leaf >> kBlockBits & 31u; }
  static_assert(SahBuilder<T>::kMostInLeaf == kBlock<T>);

  // A pack that is being put together.
  struct Making {
    const ShapeKernel<T>* kernel;
    std::vector<int> indices;
  };

  Child convert(const BoxTree<T>& tree, std::uint32_t at, const PrimitiveList<T>& primitives,
                std::vector<Making>& packs, int level) {
    depth_ = std::max(depth_, level);
    using F = FanLanes<T>;
    if (tree.nodes[at].leaf) return add_leaf(tree, tree.nodes[at], primitives, packs);
    const std::vector<std::uint32_t> children = children_of(tree, at);
    Node node;
    for (std::size_t side = 0; side < 6; ++side) node.planes[side] = F(side % 2 ? -kInfinite : kInfinite);
    node.child.fill(kLeaf);
    const std::size_t me = nodes_.size();
    nodes_.emplace_back();
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Bounds<T>& box = tree.nodes[children[i]].box;
      const std::array<T, 6> sides{box.lo.x, box.hi.x, box.lo.y, box.hi.y, box.lo.z, box.hi.z};
      for (std::size_t side = 0; side < 6; ++side) node.planes[side][i] = sides[side];
      node.child[i] = convert(tree, children[i], primitives, packs, level + 1);
    }
    nodes_[me] = node;
    return static_cast<Child>(me);
  }

  // The largest descendants that make a full node.
  static std::vector<std::uint32_t> children_of(const BoxTree<T>& tree, std::uint32_t at) {
    std::vector<std::uint32_t> children{tree.nodes[at].left, tree.nodes[at].right};
    while (children.size() < static_cast<std::size_t>(kFan<T>)) {
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

  static Child add_leaf(const BoxTree<T>& tree, const typename BoxTree<T>::Node& leaf,
                        const PrimitiveList<T>& primitives, std::vector<Making>& packs) {
    const auto primitive = [&](std::uint32_t item) -> const Primitive<T>& {
      return primitives[tree.items[item].primitive];
    };
    const auto* kernel = primitive(leaf.left).kernel;
    auto pack = std::find_if(packs.begin(), packs.end(), [&](const auto& p) { return p.kernel == kernel; });
    if (pack == packs.end()) pack = packs.insert(pack, {kernel, {}});
    std::vector<int>& indices = pack->indices;
    const auto block = static_cast<Child>(indices.size() / kBlockSize);
    for (std::uint32_t i = leaf.left; i < leaf.right; ++i) indices.push_back(primitive(i).index);
    indices.resize((block + 1) * kBlockSize, kNothing);
    return kLeaf | static_cast<Child>(pack - packs.begin()) << kBlockBits | block;
  }

  static constexpr T kInfinite = std::numeric_limits<T>::infinity();

  Child root_ = 0;
  int depth_ = 0;
  std::vector<Node> nodes_;
  std::vector<PackedPrimitivesPtr<T>> packs_;
};

}  // namespace orrery
