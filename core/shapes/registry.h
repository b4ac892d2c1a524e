#pragma once

#include <span>

#include "core/model/shape.h"

namespace orrery {

// Returns all shape types, in the order in which primitives are numbered. Thread-safe. The contracts of
// shapes, including threads and errors, are in core/model/shape.h. primitive_set.h describes how to write a
// type.
std::span<const ShapeType> shape_types();

}  // namespace orrery
