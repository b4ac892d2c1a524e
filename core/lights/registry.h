#pragma once

#include <span>

#include "core/model/light.h"

// core/lights: point, spot, line and directional lights, and sampling of emitting surfaces.
//
// Threads: a LightSet is filled by the thread that loads the scene and is thread-safe afterwards. Kernels are
// immutable and thread-safe.
// Errors: LightSet::add() records problems of the input in Params. Kernels report no errors.
namespace orrery {

// Returns all light types. LightPlace::set is an index into the span. The span is valid until the program
// exits. Thread-safe.
std::span<const LightType> light_types();

}  // namespace orrery
