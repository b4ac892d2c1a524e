#pragma once

#include <span>

#include "core/model/technique.h"

// Light transport techniques: the tracers and their common loops. Tracers are not thread-safe, so each thread
// needs a separate tracer. All tracers may share the world and the plan. Tracer::trace() returns false if
// cancelled, and throws nothing except std::bad_alloc.
namespace orrery {

// Returns all techniques, in the order of the schemas. The span is valid until the program exits.
// Thread-safe.
std::span<const TechniqueType> technique_types();

}  // namespace orrery
