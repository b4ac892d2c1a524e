#include "tests/support/rays.h"

#include <cassert>
#include <numeric>

#include "tests/support/batches.h"

namespace orrery::test {
template <class T>
Target<T>::Target(const Json& scene) : scene_(load(scene)) {
  int first = 0;
  for (const auto& set : scene_->shapes) {
    const int last = first + set->size();
    if (last > first) parts_.push_back({set->kernel(T(), first), first, last, set->traits(), set.get()});
    first = last;
  }
}

template <class T>
const typename Target<T>::Part& Target<T>::part_of(int primitive) const {
  for (const Part& part : parts_)
    if (primitive >= part.first && primitive < part.last) return part;
  assert(false);
  return parts_.front();
}

template <class T>
ShapeTraits Target<T>::traits(int primitive) const {
  return part_of(primitive).traits;
}

template <class T>
Boundsd Target<T>::bounds(int primitive) const {
  const Part& part = part_of(primitive);
  return part.set->bounds(primitive - part.first);
}

template <class T>
std::vector<Hit<T>> Target<T>::closest(std::span<const Ray<T>> rays) const {
  std::vector<int> all(static_cast<std::size_t>(primitive_count()));
  std::iota(all.begin(), all.end(), 0);
  return closest(rays, all);
}

template <class T>
std::vector<Hit<T>> Target<T>::closest(std::span<const Ray<T>> rays, std::span<const int> only) const {
  std::vector<Hit<T>> found(rays.size());
  const auto batch = std::make_unique<RayBatch<T>>();
  const auto hits = std::make_unique<HitBatch<T>>();
  AcceleratorCounts counts;
  for_each_batch(rays, [&](std::span<const Ray<T>> some, std::size_t from) {
    fill_batch(some, std::numeric_limits<T>::infinity(), *batch);
    hits->t.values = batch->t_max.values;
    hits->primitive.values.fill(kNoPrimitive);
    const LaneGroups groups = groups_of(*batch);
    for (const int primitive : only) {
      const Part& part = part_of(primitive);
      part.kernel->closest(primitive - part.first, *batch, groups, *hits, counts);
    }
    for (int i = 0; i < batch->count; ++i)
      found[from + static_cast<std::size_t>(i)] = {hits->t[i], static_cast<int>(hits->primitive[i])};
  });
  return found;
}

template <class T>
std::vector<char> Target<T>::occluded(std::span<const Ray<T>> rays, T t_max) const {
  std::vector<char> found(rays.size());
  const auto batch = std::make_unique<RayBatch<T>>();
  AcceleratorCounts counts;
  for_each_batch(rays, [&](std::span<const Ray<T>> some, std::size_t from) {
    fill_batch(some, t_max, *batch);
    const LaneGroups groups = groups_of(*batch);
    for (const Part& part : parts_)
      for (int i = 0; i < part.last - part.first; ++i) part.kernel->occlude(i, *batch, groups, counts);
    for (int i = 0; i < batch->count; ++i) found[from + static_cast<std::size_t>(i)] = batch->t_max[i] < T(0);
  });
  return found;
}

template <class T>
std::vector<SurfaceSample<T>> Target<T>::surfaces(std::span<const Ray<T>> rays,
                                                  std::span<const Hit<T>> hits) const {
  std::vector<SurfaceSample<T>> found(rays.size());
  const auto batch = std::make_unique<RayBatch<T>>();
  const auto hit_batch = std::make_unique<HitBatch<T>>();
  const auto surface = std::make_unique<SurfaceBatch<T>>();
  for_each_batch(rays, [&](std::span<const Ray<T>> some, std::size_t from) {
    fill_batch(some, std::numeric_limits<T>::infinity(), *batch);
    hit_batch->primitive.values.fill(kNoPrimitive);
    for (int i = 0; i < batch->count; ++i) {
      hit_batch->t[i] = hits[from + static_cast<std::size_t>(i)].t;
      hit_batch->primitive[i] = hits[from + static_cast<std::size_t>(i)].primitive;
    }
    const LaneGroups groups = groups_of(*batch);
    for (const Part& part : parts_) part.kernel->surface(*batch, *hit_batch, groups, *surface);
    for (int i = 0; i < batch->count; ++i)
      found[from + static_cast<std::size_t>(i)] = {surface->position[i], surface->geometric[i],
                                                   surface->normal[i], surface->side[i], surface->step[i]};
  });
  return found;
}

template class Target<float>;
template class Target<double>;
template class Target<long double>;

}  // namespace orrery::test
