#include "core/accelerators/hierarchy.h"
#include "core/accelerators/sah_builder.h"

namespace orrery {
namespace {

template <class T>
using Bvh = Hierarchy<T, SahBuilder<T>>;

}  // namespace

AcceleratorType bvh_type() {
  return {"bvh",
          "Wide BVH built with the surface area heuristic, traversed by ray packets and single rays.",
          {.ray = 9, .visit = 8, .box = 0, .primitive = 0.75},
          build_accelerator<Bvh, float>,
          build_accelerator<Bvh, double>};
}

}  // namespace orrery
