#pragma once

#include <span>

#include "core/model/shape.h"

namespace orrery {

// Every shape type, in the order in which primitives are numbered.
std::span<const ShapeType> shape_types();

}  // namespace orrery
