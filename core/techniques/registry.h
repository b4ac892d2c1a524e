#pragma once

#include <span>

#include "core/model/technique.h"

namespace orrery {

// Returns all techniques, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const TechniqueType> technique_types();

}  // namespace orrery
