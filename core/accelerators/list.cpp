#include "core/accelerators/exhaustive.h"

namespace orrery {
namespace {

template <class T>
class List final : public Accelerator<T> {
 public:
  explicit List(const PrimitiveList<T>& primitives) : primitives_(primitives) {}

  void closest(const RayBatch<T>& rays, const LaneGroups& groups, HitBatch<T>& hits,
               AcceleratorCounts& counts) const override {
    closest_exhaustive(primitives_, rays, groups, hits, counts);
  }

  void occlude(RayBatch<T>& rays, const LaneGroups& groups, AcceleratorCounts& counts) const override {
    occlude_exhaustive(primitives_, rays, groups, counts);
  }

  AcceleratorFacts facts() const override { return {.references = primitives_.size()}; }

 private:
  const PrimitiveList<T>& primitives_;
};

}  // namespace

AcceleratorType list_type() {
  return {"list",
          "List of primitives. Every ray tests all of them. Reference for the other structures.",
          {.ray = 2, .visit = 0, .box = 0, .primitive = 0.5, .each = 0.5},
          build_accelerator<List, float>,
          build_accelerator<List, double>};
}

}  // namespace orrery
