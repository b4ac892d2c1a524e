#pragma once

#include <memory>

#include "core/model/world.h"

namespace orrery {

// Returns an accelerator that finds the hits of `behind` on surfaces that are there: rays pass a surface
// whose opacity is below the cutoff of its material. Without a cutoff, rays pass with a probability of 1 -
// opacity (Enderton et al., "Stochastic Transparency", I3D 2010). The random number depends on the bits of
// the ray and on the primitive only, so images do not depend on threads. Opacity textures are evaluated at
// points, without averaging over the pixel. A ray meets the surface after kMaxPassed others in any case.
//
// `timed`: RayBatch::time is filled. REQUIRES: rays have unit directions.
template <class T>
std::shared_ptr<const Accelerator<T>> with_cutouts(std::shared_ptr<const Geometry<T>> geometry,
                                                   std::shared_ptr<const Accelerator<T>> behind, bool timed);

inline constexpr int kMaxPassed = 256;

}  // namespace orrery
