#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/plan/request.h"

namespace orrery {

// Returns the plan of a render. It contains only the stages that scene and request need. The image is
// identical, bit for bit, to that with every stage (RenderRequest::full_model). A pure, thread-safe function,
// cheap enough to call for every frame. Throws InputError for a budget with a view other than `picture`.
// REQUIRES: all other settings are values that read_request() could have returned.
Plan make_plan(const Scene& scene, const RenderRequest& request);

// Returns whether some light source has a non-zero intensity.
bool any_light_shines(const Scene& scene);

// Returns a value for every option, including those chosen by the plan. A plan made from these settings
// renders the same image with the same accelerator.
RenderSettings settings_of(const Plan& plan);

}  // namespace orrery
