#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/plan/request.h"

namespace orrery {

// Returns the stages that this scene and request need. A pure, thread-safe function, cheap enough to call for
// every frame. Throws no errors of its own: read_request() rejects invalid settings. The picture equals the
// picture with every stage present (RenderRequest::full_model), bit for bit. REQUIRES: all given settings are
// values that read_request() could have returned.
Plan make_plan(const Scene& scene, const RenderRequest& request);

// Returns whether some light source has a non-zero intensity.
bool any_light_shines(const Scene& scene);

// Returns a value for every option, including those chosen by the plan. make_plan() of these settings renders
// the same picture with the same accelerator.
RenderSettings settings_of(const Plan& plan);

}  // namespace orrery
