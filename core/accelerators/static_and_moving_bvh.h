#pragma once

#include "core/model/accelerator.h"

namespace orrery {

// Returns whether the position of any primitive depends on the rays' time (ShapeKernel::timed()).
template <class T>
bool any_timed(const PrimitiveList<T>& primitives);

// Builds a structure of `type` over the resting primitives and a separate box tree over the timed ones. Boxes
// of the tree enclose the whole motion of their primitives; batches of rays traverse it together. `before` is
// null or a structure for another time, whose resting part is refitted if possible.
template <class T>
AcceleratorPtr<T> build_static_and_moving(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                          const Accelerator<T>* before);

}  // namespace orrery
