#pragma once

#include <span>

#include "core/model/material.h"

// Material types. The thread that loads the scene reads the parameters of each material into a MaterialSet.
// Invalid parameters are recorded in Params, and reading throws Cancelled. Kernels are immutable, may be
// called by any number of threads, and throw nothing.
namespace orrery {

// Returns all material types, in the order in which materials are numbered. The span is valid until the
// program exits. Thread-safe.
std::span<const MaterialType> material_types();

}  // namespace orrery
