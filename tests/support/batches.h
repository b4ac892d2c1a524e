#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "core/model/batch.h"

// Lists of rays to batches and back.
namespace orrery::test {

// The rays as a batch whose last register is padded with inactive ones. REQUIRES: 1 to kBatch rays.
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
Groups groups_of(const RayBatch<T>& batch) {
  return Groups::covering(0, batch.count, kWidth<T>);
}

// Calls visit(part of the rays, index of its first one) for parts that fit a batch.
template <class T, class Visit>
void for_each_batch(std::span<const Ray<T>> rays, const Visit& visit) {
  for (std::size_t from = 0; from < rays.size(); from += kBatch)
    visit(rays.subspan(from, std::min<std::size_t>(kBatch, rays.size() - from)), from);
}

}  // namespace orrery::test
