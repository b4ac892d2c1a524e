#pragma once

#include "core/model/scene.h"
#include "core/render/certificate.h"

namespace orrery {

// Adds to what the technique does not follow in any scene what it cannot find in this one.
void name_lost_light(const Scene& scene, const Plan& plan, Certificate& certificate);

}  // namespace orrery
