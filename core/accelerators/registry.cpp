#include "core/accelerators/registry.h"

#include <array>

namespace orrery {

template <class T>
using Build = AcceleratorPtr<T>(const PrimitiveList<T>&);
Build<float> build_list, build_boxes;
Build<double> build_list, build_boxes;

std::span<const AcceleratorType> accelerator_types() {
  static constexpr std::array kTypes{
      AcceleratorType{"list", "Every ray against every primitive: the reference.", build_list, build_list},
      AcceleratorType{"boxes", "A box around each primitive is tested first.", build_boxes, build_boxes},
  };
  return kTypes;
}

}  // namespace orrery
