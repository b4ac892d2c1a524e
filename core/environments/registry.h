#pragma once

#include <span>

#include "core/model/environment.h"

// core/environments: environment lights, given by formulas or images.
//
// Threads: an environment is immutable and thread-safe once EnvironmentType::read() has returned it.
// Errors: read() records problems of the input in Params. It throws Cancelled and std::bad_alloc.
namespace orrery {

// Returns all environment types, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const EnvironmentType> environment_types();

}  // namespace orrery
