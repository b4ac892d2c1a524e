#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/plan/request.h"

namespace orrery {

// What to model for this scene and request, and no more: a pure function, cheap enough to call for every
// frame. The picture it leads to equals the one with every stage present (RenderRequest::full_model), bit for
// bit. Throws InputError (pointers into /image, /render, /camera) for what is out of range or unknown.
Plan make_plan(const Scene& scene, const RenderRequest& request);

}  // namespace orrery
