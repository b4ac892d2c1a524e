#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "core/model/batch.h"

// Conversion of ray lists to batches.
namespace orrery::test {

// Fills a batch with rays. The remaining elements become inactive. REQUIRES: 1 to kBatch rays.
template <class T>
void fill_batch(std::span<const Ray<T>> rays, T t_max, RayBatch<T>& batch) {
  batch.count = static_cast<int>(rays.size());
  for (int i = 0; i < kBatchRoom; ++i) {
    const bool real = i < batch.count;
    const Ray<T>& ray = rays[static_cast<std::size_t>(real ? i : 0)];
    batch.set(i, ray, real ? t_max : T(-1));
  }
}

template <class T>
LaneGroups groups_of(const RayBatch<T>& batch) {
  return LaneGroups::covering(0, batch.count, kWidth<T>);
}

// Calls visit(part, index of the part's first ray) for consecutive parts of at most kBatch rays.
template <class T, class Visit>
void for_each_batch(std::span<const Ray<T>> rays, const Visit& visit) {
  for (std::size_t from = 0; from < rays.size(); from += kBatch)
    visit(rays.subspan(from, std::min<std::size_t>(kBatch, rays.size() - from)), from);
}

}  // namespace orrery::test
