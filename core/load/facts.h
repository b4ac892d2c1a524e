#pragma once

#include "core/model/scene.h"

namespace orrery {

// Computes the facts about a scene that plans need. REQUIRES: primitives, materials and objects are numbered,
// and scene.motion is set. Throws Cancelled.
SceneFacts gather_facts(const Scene& scene);

}  // namespace orrery
