#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/model/shape.h"

namespace orrery {

// Primitive in the list that an acceleration structure is built over. An instance is one primitive. A hit on
// an instance reports the number of the primitive inside the instance.
template <class T>
struct Primitive {
  const ShapeKernel<T>* kernel;
  int index;  // within the kernel
  Boundsd bounds;
};
template <class T>
using PrimitiveList = std::vector<Primitive<T>>;

// Statistics of a built structure.
struct AcceleratorFacts {
  std::size_t bytes = 0;       // memory of the structure, without the scene
  int depth = 0;               // nodes on the longest path from the root to a primitive
  std::size_t references = 0;  // primitive references; exceeds the primitives if cells share some
  bool refitted = false;       // boxes were updated after primitives moved
  // Total surface area of the structure's boxes divided by the surface area of the primitives' boxes,
  // relative to the same quotient after the build.
  double surface_area_growth = 1;
};

// Maximum surface_area_growth of a refitted structure. Above this value, a new structure is built.
inline constexpr double kMaxSurfaceAreaGrowth = 1.5;

// Acceleration structure that finds the nearest hits of rays. The distance and the primitive are exactly
// those found by testing every primitive. At equal distances, the lower primitive number wins. Immutable once
// built, and thread-safe.
template <class T>
class Accelerator {
 public:
  virtual ~Accelerator() = default;

  virtual AcceleratorFacts facts() const = 0;

  // Returns a copy of this structure, refitted to moved primitives. `moved` has the order of the original
  // list. Returns null if a rebuild is required: refitting is not supported, or surface_area_growth would
  // exceed kMaxSurfaceAreaGrowth.
  virtual std::unique_ptr<Accelerator> refitted(const PrimitiveList<T>& /*moved*/) const { return nullptr; }

  // Finds the nearest hit of every active ray of `groups`. REQUIRES: hits.t and hits.primitive are t_max and
  // kNoPrimitive, or an earlier hit of the ray. Only a nearer hit, or a hit at the same distance with a lower
  // primitive number, replaces an earlier hit.
  virtual void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
                       AcceleratorCounts& counts) const = 0;

  // Sets t_max to -1 for every ray of `groups` that hits a primitive in (0, t_max).
  virtual void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const = 0;
};

template <class T>
using AcceleratorPtr = std::unique_ptr<Accelerator<T>>;

// Cost model: approximate nanoseconds per counted operation, for comparing structures by their counts. Fitted
// to times of `script/bench structures` on one machine, with deviations of up to 40 %. Only ratios are
// meaningful.
struct AcceleratorCosts {
  double ray, visit, box, primitive;
  double each = 0;  // per pair of ray and primitive, for structures that test every primitive

  double of(std::uint64_t rays, const AcceleratorCounts& counts) const {
    return ray * static_cast<double>(rays) + visit * static_cast<double>(counts.node_visits) +
           box * static_cast<double>(counts.box_tests) +
           primitive * static_cast<double>(counts.primitive_tests);
  }
};

// Type of acceleration structure. The list passed to `build` must outlive the accelerator. Building runs on
// the calling thread and on oneTBB workers. `build` throws Cancelled, and InputError if the structure would
// exceed a limit.
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
