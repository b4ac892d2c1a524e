#pragma once

#include <span>

#include "core/model/accelerator.h"

// core/accelerators: acceleration structures over lists of primitives, and instances of models as primitives.
//
// Threads: several threads may build structures at the same time. A build runs on the calling thread and on
// oneTBB workers. A built structure is immutable, so any number of threads may traverse and refit it.
//
// Errors: building and refitting throw Cancelled, std::bad_alloc, and InputError with pointer
// "/render/accelerator" if a shape type has more than 2^26 blocks of primitives. Traversal has no
// checkpoints. It throws only std::bad_alloc, because some structures allocate temporary batches.
namespace orrery {

// Returns all types of acceleration structures, in the order of the schemas. The span is valid until the
// program exits. Thread-safe.
std::span<const AcceleratorType> accelerator_types();

}  // namespace orrery
