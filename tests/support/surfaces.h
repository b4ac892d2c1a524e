#pragma once

#include <limits>
#include <memory>

#include "core/model/scene.h"
#include "tests/support/batches.h"
#include "tests/support/rays.h"
#include "tests/support/scenes.h"

namespace orrery::test {

// Intersects each ray with every shape of the scene and calls visit(hits, surface, i) for each ray, and for
// each type of shapes that the scene has. The surface has its parameters.
template <class T, class Visit>
void for_each_surface(const Scene& scene, const Rays<T>& rays, const Visit& visit) {
  const auto batch = std::make_unique<RayBatch<T>>();
  const auto hits = std::make_unique<HitBatch<T>>();
  const auto surface = std::make_unique<SurfaceBatch<T>>();
  for (const auto& shapes : scene.shapes) {
    if (shapes->size() == 0) continue;
    const auto kernel = shapes->kernel(T(), 0);
    for_each_batch<T>(rays, [&](std::span<const Ray<T>> some, std::size_t) {
      fill_batch(some, std::numeric_limits<T>::infinity(), *batch);
      const LaneGroups groups = groups_of(*batch);
      hits->t = batch->t_max;
      hits->primitive.values.fill(kNoPrimitive);
      AcceleratorCounts counts;
      for (int i = 0; i < shapes->size(); ++i) kernel->closest(i, *batch, groups, *hits, counts);
      kernel->surface(*batch, *hits, groups, *surface);
      kernel->parameters(*batch, groups, *hits, *surface);
      for (int i = 0; i < batch->count; ++i) visit(*hits, *surface, i);
    });
  }
}

}  // namespace orrery::test
