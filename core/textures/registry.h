#pragma once

#include <span>

#include "core/model/texture.h"

// Texture types. The thread that loads the scene reads the parameters of each texture. Invalid parameters are
// recorded in Params, and reading throws Cancelled. Textures and kernels are immutable, may be used by any
// number of threads, and throw nothing except std::bad_alloc when a kernel is made.
namespace orrery {

// Returns all texture types. The span is valid until the program exits. Thread-safe.
std::span<const TextureType> texture_types();

}  // namespace orrery
