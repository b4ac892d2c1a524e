#pragma once

#include "core/model/plan.h"
#include "core/model/rounding.h"
#include "core/model/scene.h"

namespace orrery {

// Returns the largest machine epsilon whose rounding errors stay invisible in this image, and the feature
// that requires it. The limits are calibrated, not proven: images in float and in double differ by at most
// 5e-4 (RMS, except at edges). REQUIRES: settings, camera and frame of the plan are set.
RoundingLimit rounding_limit(const Scene& scene, const Plan& plan);

}  // namespace orrery
