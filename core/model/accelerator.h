#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/model/shape.h"

namespace orrery {

// What a structure is built over: every primitive of a scene. (An instance is one; its hits have the numbers
// of what is in it.)
template <class T>
struct Primitive {
  const ShapeKernel<T>* kernel;
  int index;  // within the kernel
  Boundsd bounds;
};
template <class T>
using PrimitiveList = std::vector<Primitive<T>>;

// What a structure is, once built.
struct AcceleratorFacts {
  std::size_t bytes = 0;       // held beside the scene itself
  int depth = 0;               // nodes on the longest way to a primitive
  std::size_t references = 0;  // places that name a primitive: more than there are, where cells share some
  bool refitted = false;       // its boxes followed primitives that moved since it was built
  double surface_area_growth =
      1;  // how much larger they are since then beside what they hold, by their surfaces
};

// Beyond this surface_area_growth a new structure is built.
inline constexpr double kMaxSurfaceAreaGrowth = 1.5;

// Finds what rays meet first, exactly as testing every primitive would: the same distance and primitive,
// equal distances going to the lower number. Immutable once built; calls may run on any number of threads.
template <class T>
class Accelerator {
 public:
  virtual ~Accelerator() = default;

  virtual AcceleratorFacts facts() const = 0;

  // The same structure where the primitives have moved: `moved` has them in the same order. Null if it has to
  // be built anew, because it cannot follow, or because its boxes would be kMaxSurfaceAreaGrowth times as
  // large.
  virtual std::unique_ptr<Accelerator> refitted(const PrimitiveList<T>& /*moved*/) const { return nullptr; }

  // Nearest hit of every active ray of `groups`. REQUIRES: hits.t holds t_max and hits.primitive
  // kNoPrimitive, or the two are a hit of that ray, which then stays unless there is a nearer one, or one as
  // near of a lower number.
  virtual void closest(const RayBatch<T>& rays, const Groups& groups, HitBatch<T>& hits,
                       AcceleratorCounts& counts) const = 0;

  // Sets t_max to -1 for every ray of `groups` that meets anything in (0, t_max).
  virtual void occlude(RayBatch<T>& rays, const Groups& groups, AcceleratorCounts& counts) const = 0;
};

template <class T>
using AcceleratorPtr = std::unique_ptr<Accelerator<T>>;

// About how many nanoseconds a structure takes for each thing counted, so that structures can be compared by
// their counts: fitted to the times of `script/bench structures` on one machine, where single fits are within
// 40 %. Only ratios mean something.
struct AcceleratorCosts {
  double ray, visit, box, primitive;
  double each = 0;  // a ray, for each primitive that there is, where every one is asked

  double of(std::uint64_t rays, const AcceleratorCounts& counts) const {
    return ray * static_cast<double>(rays) + visit * static_cast<double>(counts.node_visits) +
           box * static_cast<double>(counts.box_tests) +
           primitive * static_cast<double>(counts.primitive_tests);
  }
};

// The list passed to `build` outlives the accelerator.
struct AcceleratorType {
  const char* name;
  const char* summary;
  AcceleratorCosts costs;
  AcceleratorPtr<float> (*build_float)(const PrimitiveList<float>&);
  AcceleratorPtr<double> (*build_double)(const PrimitiveList<double>&);
};

template <template <class> class Structure, class T>
AcceleratorPtr<T> build_accelerator(const PrimitiveList<T>& primitives) {
  return std::make_unique<Structure<T>>(primitives);
}

template <class T>
AcceleratorPtr<T> build(const AcceleratorType& type, const PrimitiveList<T>& primitives) {
  if constexpr (std::is_same_v<T, float>)
    return type.build_float(primitives);
  else
    return type.build_double(primitives);
}

}  // namespace orrery
