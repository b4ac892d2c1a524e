#pragma once

#include <span>

#include "core/model/environment.h"

namespace orrery {

// Returns all environment types, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const EnvironmentType> environment_types();

}  // namespace orrery
