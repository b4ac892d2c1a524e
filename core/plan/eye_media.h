#pragma once

#include "core/model/media.h"
#include "core/model/plan.h"

namespace orrery {

// Returns whether the bounds of a body contain the eye, extended by the lens, or whether the camera has no
// eye. REQUIRES: the camera and the frame of the plan are set.
bool may_start_in(const Media& media, const Plan& plan);

}  // namespace orrery
