#pragma once

#include <span>

#include "core/model/shape.h"

namespace orrery {

// Returns all shape types, in the order in which primitives are numbered.
std::span<const ShapeType> shape_types();

}  // namespace orrery
