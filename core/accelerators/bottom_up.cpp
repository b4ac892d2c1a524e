#include <numeric>

#include "core/accelerators/hierarchy.h"
#include "core/base/parallel.h"

namespace orrery {
namespace {

// Bottom-up builder: merges pairs of groups with the nearest boxes until one group is left. The distance
// between two boxes is the surface area of their union. Only neighbours along a space-filling curve are
// compared (Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
// Construction", TVCG 2018). A group of at most kBlock<T> primitives of one kernel becomes a leaf.
template <class T>
class BottomUpBuilder {
 public:
  static BoxTree<T> build(std::vector<TreeItem<T>> items) {
    if (items.empty()) return {};
    BottomUpBuilder grouping(std::move(items));
    while (grouping.line_.size() > 1) grouping.merge_neighbours();
    grouping.tree_.nodes.emplace_back();
    grouping.fill(0, grouping.line_[0], 0);
    return std::move(grouping.tree_);
  }

 private:
  static constexpr std::uint32_t kMixed = ~0u, kSingle = ~0u;
  static constexpr std::size_t kGrain = 4096;  // grain size of parallel loops, in groups
  static constexpr int kReach = 8;             // groups compared on each side along the curve

  struct Group {
    Bounds<T> box;
    std::uint32_t left, right;  // child groups; for a single item: its index in items_, and kSingle
    std::uint32_t count, kernel;
  };

  explicit BottomUpBuilder(std::vector<TreeItem<T>> items) : items_(std::move(items)) {
    Boundsd all;
    for (const auto& item : items_) all.include(center(item));
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(items_.size());
    parallel_for_each(order.size(), kGrain, [&](std::size_t i) {
      order[i] = {curve_place(all, center(items_[i])), static_cast<std::uint32_t>(i)};
    });
    sort_in_parallel(order.begin(), order.end());
    groups_.reserve(2 * items_.size());
    for (const auto& [place, item] : order)
      groups_.push_back({items_[item].box, item, kSingle, 1, items_[item].kernel});
    line_.resize(groups_.size());
    std::iota(line_.begin(), line_.end(), 0u);
    tree_.items.reserve(items_.size());
  }

  static Vec3d center(const TreeItem<T>& item) { return (Vec3d(item.box.lo) + Vec3d(item.box.hi)) * 0.5; }

  // Returns the position of `at` along the Z-order curve through `all`, with 21 bits per axis.
  static std::uint64_t curve_place(const Boundsd& all, const Vec3d& at) {
    const auto spread = [](double from, double to, double x) {
      const double cells = 2097151;
      const double cell = to > from ? (x - from) / (to - from) * cells : 0;
      std::uint64_t bits = static_cast<std::uint64_t>(std::clamp(cell, 0.0, cells));
      bits = (bits | bits << 32) & 0x001f00000000ffff;
      bits = (bits | bits << 16) & 0x001f0000ff0000ff;
      bits = (bits | bits << 8) & 0x100f00f00f00f00f;
      bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
      return (bits | bits << 2) & 0x1249249249249249;
    };
    return spread(all.lo.x, all.hi.x, at.x) | spread(all.lo.y, all.hi.y, at.y) << 1 |
           spread(all.lo.z, all.hi.z, at.z) << 2;
  }

  // Merges pairs of groups that are each other's nearest neighbours. At least one such pair exists, because
  // nearest_of() breaks ties: the group nearer along the curve wins, and groups at equal distances along the
  // curve are paired consistently.
  void merge_neighbours() {
    const int count = static_cast<int>(line_.size());
    std::vector<int> nearest(line_.size());
    parallel_for_each(nearest.size(), kGrain,
                      [&](std::size_t i) { nearest[i] = nearest_of(static_cast<int>(i)); });
    std::vector<std::uint32_t> next;
    next.reserve(line_.size());
    for (int i = 0; i < count; ++i) {
      checkpoint(static_cast<std::size_t>(i));
      const int j = nearest[static_cast<std::size_t>(i)];
      const bool mutual = nearest[static_cast<std::size_t>(j)] == i;
      if (!mutual) next.push_back(at(i));
      if (mutual && i < j) next.push_back(merge(at(i), at(j)));
    }
    // If box sizes or gaps grow steadily along the curve, only one pair is mutual. A pass that removes less
    // than about 1/32 of the groups therefore also merges adjacent groups in pairs. This keeps the number of
    // passes logarithmic.
    constexpr std::size_t kFewest = 32;
    if (next.size() + next.size() / kFewest > line_.size()) next = pairs_of(next);
    line_ = std::move(next);
  }

  std::vector<std::uint32_t> pairs_of(const std::vector<std::uint32_t>& line) {
    std::vector<std::uint32_t> pairs;
    pairs.reserve(line.size() / 2 + 1);
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) pairs.push_back(merge(line[i], line[i + 1]));
    if (line.size() % 2 == 1) pairs.push_back(line.back());
    return pairs;
  }

  std::uint32_t at(int i) const { return line_[static_cast<std::size_t>(i)]; }

  int nearest_of(int i) const {
    const int count = static_cast<int>(line_.size());
    T least = std::numeric_limits<T>::infinity();
    int best = i;
    for (int distance = 1; distance <= kReach; ++distance) {
      const bool up_first = i / distance % 2 == 0;
      for (const int j : {up_first ? i + distance : i - distance, up_first ? i - distance : i + distance}) {
        if (j < 0 || j >= count) continue;
        Bounds<T> both = groups_[at(i)].box;
        both.include(groups_[at(j)].box);
        const T size = half_area(both);
        if (size < least || best == i) least = size, best = j;
      }
    }
    return best;
  }

  std::uint32_t merge(std::uint32_t a, std::uint32_t b) {
    Group both{groups_[a].box, a, b, groups_[a].count + groups_[b].count,
               groups_[a].kernel == groups_[b].kernel ? groups_[a].kernel : kMixed};
    both.box.include(groups_[b].box);
    groups_.push_back(both);
    return static_cast<std::uint32_t>(groups_.size() - 1);
  }

  // Stores the subtree of a group at tree node `node`.
  void fill(std::size_t node, std::uint32_t group, int depth) {
    checkpoint();
    const Group& g = groups_[group];
    tree_.nodes[node].box = g.box;
    const bool leaf = g.count <= static_cast<std::uint32_t>(kBlock<T>) && g.kernel != kMixed;
    if (leaf || depth >= kDepthGuard) {
      const auto from = static_cast<std::uint32_t>(tree_.items.size());
      append_items(group);
      return halve(node, from, static_cast<std::uint32_t>(tree_.items.size()));
    }
    const std::size_t children = add_children(node);
    fill(children, g.left, depth + 1);
    fill(children + 1, g.right, depth + 1);
  }

  std::size_t add_children(std::size_t node) {
    const std::size_t left = tree_.nodes.size();
    tree_.nodes.resize(left + 2);
    tree_.nodes[node].left = static_cast<std::uint32_t>(left);
    tree_.nodes[node].right = static_cast<std::uint32_t>(left + 1);
    return left;
  }

  void append_items(std::uint32_t group) {
    std::vector<std::uint32_t> open{group};
    while (!open.empty()) {
      const Group& g = groups_[open.back()];
      open.pop_back();
      if (g.right == kSingle) {
        tree_.items.push_back(items_[g.left]);
      } else {
        open.push_back(g.right);
        open.push_back(g.left);
      }
    }
  }

  void halve(std::size_t node, std::uint32_t from, std::uint32_t to) {
    Bounds<T> box;
    bool mixed = false;
    for (std::uint32_t i = from; i < to; ++i) {
      box.include(tree_.items[i].box);
      mixed = mixed || tree_.items[i].kernel != tree_.items[from].kernel;
    }
    auto& n = tree_.nodes[node];
    n.box = box;
    if (!mixed && to - from <= static_cast<std::uint32_t>(kBlock<T>)) {
      n.leaf = true;
      n.left = from;
      n.right = to;
      return;
    }
    const std::size_t children = add_children(node);
    const std::uint32_t middle = from + (to - from) / 2;
    halve(children, from, middle);
    halve(children + 1, middle, to);
  }

  std::vector<TreeItem<T>> items_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> line_;  // groups that have no parent yet, in curve order
  BoxTree<T> tree_;
};

template <class T>
using BottomUp = Hierarchy<T, BottomUpBuilder<T>>;

}  // namespace

AcceleratorType bottom_up_type() {
  return {"bottom-up",
          "BVH built bottom-up by merging the nearest boxes.",
          {.ray = 9, .visit = 13, .box = 0, .primitive = 0.9},
          build_accelerator<BottomUp, float>,
          build_accelerator<BottomUp, double>};
}

}  // namespace orrery
