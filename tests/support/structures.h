#pragma once

#include <functional>
#include <string>

#include "core/model/world.h"
#include "tests/support/rays.h"

// Registered accelerators over the shapes of a scene.
namespace orrery::test {

std::vector<std::string> accelerator_names();

// Function that wraps an accelerator in another stage.
template <class T>
using Stage = std::function<std::shared_ptr<const Accelerator<T>>(const PrimitiveList<T>&,
                                                                  std::shared_ptr<const Accelerator<T>>)>;

template <class T>
class Structure {
 public:
  Structure(const Json& scene, const std::string& accelerator, const Stage<T>& stage = {});
  // Builds the structure over the scene at `time`, or refits `before` if possible.
  Structure(const std::shared_ptr<const Scene>& scene, const std::string& accelerator, double time,
            const Structure* before = nullptr);

  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays);
  // Returns the same hits, starting from an already known hit of each ray. REQUIRES: one known hit per ray.
  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays, std::span<const Hit<T>> known);
  std::vector<char> occluded(std::span<const Ray<T>> rays, T t_max);
  AcceleratorFacts facts() const { return accelerator_->facts(); }
  const Geometry<T>& geometry() const { return *geometry_; }
  const std::shared_ptr<const Accelerator<T>>& accelerator() const { return accelerator_; }
  const AcceleratorCounts& counts() const { return counts_; }  // sum over all calls

 private:
  std::shared_ptr<const Geometry<T>> geometry_;
  std::shared_ptr<const Accelerator<T>> accelerator_;
  AcceleratorCounts counts_;
};

extern template class Structure<float>;
extern template class Structure<double>;

}  // namespace orrery::test
