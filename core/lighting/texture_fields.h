#pragma once

#include "core/model/scene.h"

namespace orrery {

// Returns the surface fields that the textures of the scene need.
SurfaceFields texture_fields(const Scene& scene);

}  // namespace orrery
