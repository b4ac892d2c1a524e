#pragma once

#include "core/model/accelerator.h"

namespace orrery {

// Returns whether the position of any primitive depends on the rays' time (ShapeKernel::timed()).
template <class T>
bool any_timed(const PrimitiveList<T>& primitives);

// Builds a structure of `type` over the static primitives and a separate BVH over the timed primitives. Boxes
// of the BVH enclose the whole motion of their primitives, and all rays of a batch traverse the BVH together.
// `before` is null or the structure for another exposure, whose static part is refitted if possible. The list
// may be destroyed after the call, but its kernels must outlive the structure. Thread-safe. Throws Cancelled,
// std::bad_alloc, and the errors of `type`.
template <class T>
AcceleratorPtr<T> build_static_and_moving(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                          const Accelerator<T>* before);

}  // namespace orrery
