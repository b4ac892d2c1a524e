#pragma once

#include <cstddef>
#include <vector>

#include "core/model/world.h"

namespace orrery {

// Maximum number of emitting primitives of instances that are sampled. Sorting more of them takes longer than
// sampling saves.
inline constexpr std::size_t kMaxInstancedEmitters = std::size_t{1} << 16;

// Adds the emission of materials, and the emitting surfaces that are sampled, at the start of the exposure.
// Returns the bounds of these surfaces. Other emitters are found only by rays that happen to hit them: those
// without a Patch or without area, solids that enclose the scene, those that move during the exposure or
// within their model, and all instances if they have more than kMaxInstancedEmitters emitting primitives.
// Throws Cancelled. REQUIRES: the geometry's primitives are numbered.
template <class T>
std::vector<LightBounds> add_emitters(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry);

}  // namespace orrery
