#pragma once

#include <span>

#include "core/model/atmosphere.h"

// core/atmospheres: changes of light on its way to the eye, one type per file.
//
// Threads: an atmosphere is immutable and thread-safe once AtmosphereType::read() has returned it.
// Errors: read() records problems of the input in Params. It throws std::bad_alloc.
namespace orrery {

// Returns all atmosphere types, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const AtmosphereType> atmosphere_types();

}  // namespace orrery
