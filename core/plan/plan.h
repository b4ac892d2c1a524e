#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/plan/request.h"

namespace orrery {

// What to model for this scene and request, and no more: a pure function, cheap enough to call for every
// frame. The picture it leads to equals the one with every stage present (RenderRequest::full_model), bit for
// bit. REQUIRES: the settings of the request, where given, are ones that read_request() could have returned.
Plan make_plan(const Scene& scene, const RenderRequest& request);

// Whether some light source has an intensity other than 0.
bool any_light_shines(const Scene& scene);

// Every option, with what the plan decided in place of what was left to it: make_plan() of these settings
// renders the same picture, by the same structure.
RenderSettings settings_of(const Plan& plan);

}  // namespace orrery
