#include "tests/support/structures.h"

#include <stdexcept>

#include "core/accelerators/registry.h"
#include "core/prepare/geometry.h"
#include "tests/support/batches.h"

namespace orrery::test {

std::vector<std::string> accelerator_names() {
  std::vector<std::string> names;
  for (const auto& type : accelerator_types()) names.push_back(type.name);
  return names;
}

template <class T>
Structure<T>::Structure(const Json& scene, const std::string& accelerator, const Stage<T>& stage)
    : Structure(load(scene), accelerator, 0) {
  if (stage) accelerator_ = stage(geometry_->primitives, std::move(accelerator_));
}

template <class T>
Structure<T>::Structure(const std::shared_ptr<const Scene>& scene, const std::string& accelerator,
                        double time, const Structure* before) {
  for (const auto& type : accelerator_types())
    if (type.name == accelerator) {
      geometry_ = make_geometry<T>(scene, type, time, before ? before->geometry_.get() : nullptr);
      accelerator_ =
          build_or_refit(type, geometry_->primitives, before ? before->accelerator_.get() : nullptr);
    }
  if (!accelerator_) throw std::invalid_argument(accelerator);
}

template <class T>
std::vector<Hit<T>> Structure<T>::closest(std::span<const Ray<T>> rays) {
  return closest(rays, std::vector<Hit<T>>(rays.size()));
}

template <class T>
std::vector<Hit<T>> Structure<T>::closest(std::span<const Ray<T>> rays, std::span<const Hit<T>> known) {
  std::vector<Hit<T>> found(rays.size());
  const auto batch = std::make_unique<RayBatch<T>>();
  const auto hits = std::make_unique<HitBatch<T>>();
  for_each_batch(rays, [&](std::span<const Ray<T>> some, std::size_t from) {
    fill_batch(some, std::numeric_limits<T>::infinity(), *batch);
    hits->t.values = batch->t_max.values;
    hits->primitive.values.fill(kNoPrimitive);
    for (int i = 0; i < batch->count; ++i) {
      const Hit<T>& hit = known[from + static_cast<std::size_t>(i)];
      hits->t[i] = hit.t;
      hits->primitive[i] = hit.primitive;
    }
    accelerator_->closest(*batch, groups_of(*batch), *hits, counts_);
    for (int i = 0; i < batch->count; ++i)
      found[from + static_cast<std::size_t>(i)] = {hits->t[i], static_cast<int>(hits->primitive[i])};
  });
  return found;
}

template <class T>
std::vector<char> Structure<T>::occluded(std::span<const Ray<T>> rays, T t_max) {
  std::vector<char> found(rays.size());
  const auto batch = std::make_unique<RayBatch<T>>();
  for_each_batch(rays, [&](std::span<const Ray<T>> some, std::size_t from) {
    fill_batch(some, t_max, *batch);
    accelerator_->occlude(*batch, groups_of(*batch), counts_);
    for (int i = 0; i < batch->count; ++i) found[from + static_cast<std::size_t>(i)] = batch->t_max[i] < T(0);
  });
  return found;
}

template class Structure<float>;
template class Structure<double>;

}  // namespace orrery::test
