#pragma once

#include <cstddef>
#include <vector>

#include "core/model/world.h"

namespace orrery {

// Where more surfaces of instances emit, it takes longer to sort them than it pays.
inline constexpr std::size_t kMostInstancedEmitters = std::size_t{1} << 16;

// The radiance that materials send out, and the surfaces from which light is drawn, as they stand when the
// exposure begins. Returns the bounds of these. Others that emit are met by chance alone: what no Patch
// describes, what moves during the exposure, what moves within its model, and all instances if they have more
// than kMostInstancedEmitters. REQUIRES: the geometry's primitives are numbered.
template <class T>
std::vector<LightBounds> add_emitters(const Scene& scene, const Exposure& exposure, Geometry<T>& geometry);

}  // namespace orrery
