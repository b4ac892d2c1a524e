#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/model/tessellation.h"

namespace orrery {

// Returns triangles that are within the requested number of pixels of the surfaces of the scene at
// Plan::time, in scene coordinates. Throws Cancelled, and InputError (/render/technique) if there are more
// than `max_triangles`.
Tessellation tessellate(const Scene& scene, const Plan& plan, std::size_t max_triangles);

}  // namespace orrery
