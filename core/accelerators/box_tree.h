#pragma once

#include <vector>

#include "core/base/task_scope.h"
#include "core/model/accelerator.h"

namespace orrery {

// Bounded primitive as input of a tree builder.
template <class T>
struct TreeItem {
  Bounds<T> box;
  std::uint32_t primitive;  // index in the PrimitiveList
  std::uint32_t kernel;     // run of primitives with one kernel; a leaf has items of one run
};

// Returns the bounded primitives of the list, with padded boxes. Throws Cancelled.
template <class T>
std::vector<TreeItem<T>> items_of(const PrimitiveList<T>& primitives) {
  std::vector<TreeItem<T>> items;
  items.reserve(primitives.size());
  const ShapeKernel<T>* last = nullptr;
  std::uint32_t kernel = 0;  // counts runs; primitives of one kernel are adjacent in the list
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    checkpoint(i);
    if (primitives[i].kernel != last) ++kernel;
    last = primitives[i].kernel;
    if (!primitives[i].bounds.bounded()) continue;
    items.push_back({padded<T>(primitives[i].bounds), static_cast<std::uint32_t>(i), kernel});
  }
  return items;
}

// Depth from which builders split the items of a node into halves of equal count. This bounds the depth for
// any input: 28 levels of halving reduce 2^31 items to blocks of 8. At most 8 more levels divide a block into
// leaves of one kernel.
inline constexpr int kDepthGuard = 48;
inline constexpr int kDeepestTree = kDepthGuard + 28 + 8;

// Binary tree of boxes. nodes[0] is the root. Each leaf refers to a range of items.
template <class T>
struct BoxTree {
  struct Node {
    Bounds<T> box;
    std::uint32_t left = 0, right = 0;  // indices of the children; in a leaf: items [left, right)
    bool leaf = false;
  };
  std::vector<Node> nodes;  // some may be unused
  std::vector<TreeItem<T>> items;
  bool empty() const { return items.empty(); }
};

template <class T>
inline T half_area(const Bounds<T>& b) {
  const Vec3<T> d = b.hi - b.lo;
  return d.x >= 0 ? d.x * d.y + d.y * d.z + d.z * d.x : T(0);
}

}  // namespace orrery
