#pragma once

#include "core/model/plan.h"
#include "core/model/rounding.h"
#include "core/model/scene.h"

namespace orrery {

// Returns the largest machine epsilon whose rounding errors stay invisible in this image, and the scene
// feature that sets this limit. The epsilon is infinite if no feature does. The limits are calibrated, not
// proven: if float is within the limit, images in float and in double differ by at most 5e-4 (RMS, except at
// edges). Thread-safe; throws only std::bad_alloc. REQUIRES: settings, camera and frame of the plan are set.
RoundingLimit rounding_limit(const Scene& scene, const Plan& plan);

}  // namespace orrery
