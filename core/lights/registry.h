#pragma once

#include <span>

#include "core/model/light.h"

namespace orrery {

// Returns all light types, numbered as LightPlace::set. The span is valid until the program exits.
// Thread-safe.
std::span<const LightType> light_types();

}  // namespace orrery
