#pragma once

#include <span>

#include "core/model/camera.h"

// core/cameras: camera models, pixel filters, and sampling of the lens and of the exposure.
//
// Threads: all functions are thread-safe.
// Errors: CameraType::read() records problems of the input in Params. The other functions report no errors.
namespace orrery {

// Returns all camera types, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const CameraType> camera_types();

}  // namespace orrery
