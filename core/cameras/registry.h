#pragma once

#include <span>

#include "core/model/camera.h"

namespace orrery {

// Returns all camera types, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const CameraType> camera_types();

}  // namespace orrery
