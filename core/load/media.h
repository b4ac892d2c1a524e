#pragma once

#include "core/model/scene.h"

namespace orrery {

// Finds the surfaces with a medium. Returns an empty result if no ray can be inside two bodies at once,
// nothing can be inside a body that absorbs light, and no body scatters light: a ray then needs no memory of
// the bodies around it.
// Decides by bounds, which may overlap although the bodies do not. REQUIRES: primitives, materials and
// objects are numbered. Throws Cancelled.
Media find_media(const Scene& scene);

}  // namespace orrery
