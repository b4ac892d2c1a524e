#pragma once

#include <cstddef>
#include <vector>

#include "core/model/world.h"

namespace orrery {

// Maximum number of emitting primitives of instances that are sampled. With more, sorting them takes longer
// than it saves.
inline constexpr std::size_t kMaxInstancedEmitters = std::size_t{1} << 16;

// Adds the emission of materials, and the surfaces that light is sampled from, at the start of the exposure.
// Returns the bounds of these surfaces. Other emitters are found only by chance: those without a Patch, those
// that move during the exposure or within their model, and all instances if they have more than
// kMaxInstancedEmitters. Throws Cancelled. REQUIRES: the geometry's primitives are numbered.
template <class T>
std::vector<LightBounds> add_emitters(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry);

}  // namespace orrery
