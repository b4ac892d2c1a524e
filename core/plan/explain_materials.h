#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// Adds a decision for each texture of the scene, and one for materials that let rays pass. Thread-safe for
// different plans.
void explain_materials(const Scene& scene, Plan& plan);

}  // namespace orrery
