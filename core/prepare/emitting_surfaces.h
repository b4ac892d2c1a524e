#pragma once

#include <cstddef>
#include <vector>

#include "core/model/world.h"

namespace orrery {

// Maximum number of emitting primitives in instances for which light sampling is used. Building the light
// tree over more primitives takes longer than light sampling saves.
inline constexpr std::size_t kMaxInstancedEmitters = std::size_t{1} << 16;

// Adds to `geometry` a kernel of the emitting surfaces that are sampled, at their places at the start of the
// exposure. Returns the bounds of these surfaces. Other emitters are found
// only by rays that happen to hit them: emitters without a Patch or without area, solids that enclose the
// scene, emitters that move during the exposure or within a model, and all emitters of instances if there are
// more than kMaxInstancedEmitters. Throws Cancelled. REQUIRES: material_of and emission are
// set.
template <class T>
std::vector<LightBounds> add_emitters(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry);

}  // namespace orrery
