#pragma once

#include "core/model/scene.h"

namespace orrery {

// What the plan wants to know about a scene that is read but for this. REQUIRES: its primitives, materials
// and objects are numbered, its motion is known.
SceneFacts gather_facts(const Scene& scene);

}  // namespace orrery
