#pragma once

#include <vector>

#include "core/base/error.h"
#include "core/model/counts.h"
#include "core/model/plan.h"
#include "core/model/scene.h"

// Warnings about valid scenes whose picture is useless. Pointers refer to the scene.
namespace orrery {

// Returns the warnings that are known before rendering:
//  - no light reaches any surface: no light source, no ambient light, no emission;
//  - the camera is inside a closed opaque shape that contains no light and, if there is ambient light or
//    emission, nothing else;
//  - caustics of a light without extent are lost, because paths cannot hit the light;
//  - nothing is in view, because the boxes of all primitives are outside the view volume.
// The time is bounded for any scene. With more than 20,000 primitives, or 8 shapes around the camera, a
// warning may be missed.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan);

// Returns the warnings of a rendered picture. The ray counts show exactly whether anything is in view.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan, const TraceCounts& traced);

// Returns whether paths cannot find caustics of a light without extent.
bool loses_caustics(const Scene& scene, const Plan& plan);

}  // namespace orrery
