#pragma once

#include <string>

#include "core/model/world.h"
#include "tests/support/rays.h"

// Registered accelerators over the shapes of a scene.
namespace orrery::test {

std::vector<std::string> accelerator_names();

template <class T>
class Structure {
 public:
  Structure(const Json& scene, const std::string& accelerator);

  std::vector<Hit<T>> closest(std::span<const Ray<T>> rays);
  std::vector<char> occluded(std::span<const Ray<T>> rays, T t_max);
  AcceleratorFacts facts() const { return accelerator_->facts(); }
  const AcceleratorCounts& counts() const { return counts_; }  // of all calls so far

 private:
  std::shared_ptr<const Geometry<T>> geometry_;
  AcceleratorPtr<T> accelerator_;
  AcceleratorCounts counts_;
};

extern template class Structure<float>;
extern template class Structure<double>;

}  // namespace orrery::test
