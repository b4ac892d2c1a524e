#pragma once

#include "core/model/accelerator.h"

namespace orrery {

// Whether some primitives stand where they are at the rays' time (ShapeKernel::timed()).
template <class T>
bool any_timed(const PrimitiveList<T>& primitives);

// A structure of `type` over the primitives that rest, and beside it one over those that are timed: a tree of
// boxes around all that each passes, which batches of rays walk. `before`: one at another moment or null,
// whose part for what rests is followed where it can be.
template <class T>
AcceleratorPtr<T> build_beside_moving(const AcceleratorType& type, const PrimitiveList<T>& primitives,
                                      const Accelerator<T>* before);

}  // namespace orrery
