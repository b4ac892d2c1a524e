#pragma once

#include "core/model/scene.h"

namespace orrery {

// Returns the JSON Pointer of the object or instance that a primitive belongs to.
inline std::string pointer_to_object(const Scene& scene, int primitive) {
  const int object = scene.object_runs[scene.object_run_of(primitive)].object;
  const int resting = scene.object_count - static_cast<int>(scene.instances.size());
  return object < resting ? "/objects/" + std::to_string(object)
                          : "/instances/" + std::to_string(object - resting);
}

}  // namespace orrery
