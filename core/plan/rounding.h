#pragma once

#include "core/model/plan.h"
#include "core/model/rounding.h"
#include "core/model/scene.h"

namespace orrery {

// How fine the numbers must be that such a picture is computed with, and what needs them so. REQUIRES: the
// plan's settings, camera and frame are known. Until the error of a picture is bounded, the limits are
// calibrated: pictures in float and in double differ by 5e-4 at most (root of the mean square, off edges).
RoundingLimit rounding_limit(const Scene& scene, const Plan& plan);

}  // namespace orrery
