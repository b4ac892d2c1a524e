#pragma once

#include <string>

#include "server/import/scene_writer.h"

namespace orrery {

// Adds radiance from all directions. Constant radiance adds up. An image excludes other surroundings, which
// are left out with a note.
void add_constant_environment(SceneWriter& scene, const Vec3d& radiance);

// Order of the directions in an image of the surroundings.
enum class EnvironmentLayout {
  // Square: equal-area octahedral (Clarberg 2008), as in pbrt-v4. Otherwise equirectangular with +z at the
  // top
  // and +x at the left edge, turning toward +y, as in pbrt-v3.
  pbrt,
  // Equirectangular with +y at the top and -z at the left edge, turning toward +x.
  mitsuba
};

// Adds an image of the surroundings, in the axes of the light. `map` takes them to the scene.
void add_image_environment(SceneWriter& scene, const ReadNearby& nearby, const std::string& file,
                           EnvironmentLayout layout, const Affined& map, const Vec3d& scale);

}  // namespace orrery
