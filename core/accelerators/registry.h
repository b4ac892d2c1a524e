#pragma once

#include <span>

#include "core/model/accelerator.h"

namespace orrery {

// Returns all acceleration structures, in the order of the schemas. The span is valid until the program
// exits. Thread-safe.
std::span<const AcceleratorType> accelerator_types();

}  // namespace orrery
