#include "core/accelerators/oriented_box.h"
#include "core/accelerators/sah_builder.h"

namespace orrery {
namespace {

// Binary tree of axis-aligned boxes. A node also has an oriented box if it is much smaller than the
// axis-aligned box (Gottschalk, Lin, Manocha, "OBBTree: A Hierarchical Structure for Rapid Interference
// Detection", 1996).
template <class T>
class OrientedTree {
 public:
  explicit OrientedTree(const PrimitiveList<T>& primitives) {
    const BoxTree<T> tree = SahBuilder<T>::build(items_of(primitives));
    if (tree.empty()) return;
    std::vector<HullTriangle> hull;
    nodes_.emplace_back();
    fill(0, tree, 0, primitives, 1, hull);
    blocks_.pack();
  }

  bool empty() const { return nodes_.empty(); }
  AcceleratorFacts facts() const {
    return {
        .bytes = nodes_.size() * sizeof(Node) + oriented_.size() * sizeof(OrientedBox<T>) + blocks_.bytes(),
        .depth = depth_,
        .references = blocks_.references()};
  }

  template <Query kQuery>
  void traverse(TraversalState<T>& state) const {
    std::array<Entry, kDeepestTree + 1> open;
    std::size_t count = 0;
    if (T from(0); enters(state, nodes_[0], from)) open[count++] = {0, from};
    while (count > 0) {
      const Entry at = open[--count];
      if (!state.open(at.from)) continue;
      ++state.counts.node_visits;
      const Node& node = nodes_[at.node];
      if (node.leaf) {
        state.template meet<kQuery>(blocks_, std::span(&node.next, 1));
        continue;
      }
      Entry near{node.next, T(0)}, far{node.next + 1, T(0)};
      const bool enters_near = enters(state, nodes_[near.node], near.from);
      const bool enters_far = enters(state, nodes_[far.node], far.from);
      if (enters_near && enters_far && far.from < near.from) std::swap(near, far);
      if (enters_far) open[count++] = far;
      if (enters_near) open[count++] = near;
    }
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  struct Node {
    Bounds<T> box;
    std::uint32_t oriented = kNone;  // index, or kNone
    std::uint32_t next = 0;          // first of two adjacent children; in a leaf: name of its block
    bool leaf = false;
  };
  struct Entry {
    std::uint32_t node;
    T from;
  };

  bool enters(TraversalState<T>& state, const Node& node, T& from) const {
    T to = state.hit.t;
    ++state.counts.box_tests;
    if (!state.probe.clip(node.box, from, to)) return false;
    if (node.oriented == kNone) return true;
    ++state.counts.box_tests;
    return oriented_[node.oriented].clip(state.ray.ray, from, to);
  }

  // Converts the subtree at node `at` of the tree to node `me`. Appends the hull triangles of its primitives
  // to `hull`. Returns the moments of these triangles.
  SurfaceMoments fill(std::size_t me, const BoxTree<T>& tree, std::uint32_t at,
                      const PrimitiveList<T>& primitives, int level, std::vector<HullTriangle>& hull) {
    checkpoint();
    depth_ = std::max(depth_, level);
    const auto& node = tree.nodes[at];
    const std::size_t first = hull.size();
    SurfaceMoments moments;
    Node made{.box = node.box, .leaf = node.leaf};
    if (node.leaf) {
      std::vector<std::uint32_t> places;
      for (std::uint32_t i = node.left; i < node.right; ++i) places.push_back(tree.items[i].primitive);
      for (const std::uint32_t place : places)
        for (const HullTriangle& triangle : hull_of(primitives[place])) {
          moments.add(triangle);
          hull.push_back(triangle);
        }
      made.next = blocks_.add(primitives, places);
    } else {
      made.next = static_cast<std::uint32_t>(nodes_.size());
      nodes_.resize(nodes_.size() + 2);
      moments = fill(made.next, tree, node.left, primitives, level + 1, hull);
      moments.add(fill(made.next + 1, tree, node.right, primitives, level + 1, hull));
    }
    const auto oriented = OrientedBox<T>::around(principal_axes(moments), std::span(hull).subspan(first));
    if (oriented_pays(oriented, node.box)) {
      made.oriented = static_cast<std::uint32_t>(oriented_.size());
      oriented_.push_back(oriented);
    }
    nodes_[me] = made;
    return moments;
  }

  std::vector<Node> nodes_;
  std::vector<OrientedBox<T>> oriented_;
  Blocks<T> blocks_;
  int depth_ = 0;
};

template <class T>
using ObbTree = SingleRayAccelerator<T, OrientedTree<T>>;

}  // namespace

AcceleratorType obb_tree_type() {
  return {"obb-tree",
          "Hierarchy of oriented bounding boxes.",
          {.ray = 54, .visit = 0, .box = 3.1, .primitive = 5.7},
          build_accelerator<ObbTree, float>,
          build_accelerator<ObbTree, double>};
}

}  // namespace orrery
