#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"
#include "core/plan/request.h"

// Planning of a render: this folder owns the render options (options.h) and the limits of scenes and requests
// (limits.h), and turns a scene and a request into a Plan. It also estimates rays (cost.h) and acceptable
// rounding (rounding.h), and finds scenes with an unintended image (warnings.h).
//
// All functions of the folder are thread-safe and depend only on their arguments. Invalid options throw
// InputError or are recorded in Params, as their headers say. find_warnings() throws Cancelled. Every
// function that returns text or a container may throw std::bad_alloc.
namespace orrery {

// Returns the plan of a render. The plan contains only the stages that scene and request need. They render
// the same image, bit for bit, as all stages together (RenderRequest::full_model). Cheap enough to call for
// every frame. Throws InputError for a budget with a view other than `picture`. REQUIRES: all other settings
// are values that read_request() could have returned.
Plan make_plan(const Scene& scene, const RenderRequest& request);

// Returns whether a light source of the scene has a non-zero intensity.
bool any_light_shines(const Scene& scene);

// Returns a value for every option, including the values chosen by the plan. A plan made from these settings
// renders the same image with the same accelerator.
RenderSettings settings_of(const Plan& plan);

}  // namespace orrery
