#pragma once

#include <vector>

#include "core/base/error.h"
#include "core/model/counts.h"
#include "core/model/plan.h"
#include "core/model/scene.h"

// Warnings about valid scenes whose image is probably not as intended. Pointers refer to the scene.
namespace orrery {

// Returns the warnings that are known before rendering:
//  - no light reaches any surface: no light source, no ambient light, no emission;
//  - the camera is inside a closed opaque shape that contains no light and, if there is ambient light or
//    emission, nothing else;
//  - a material reflects more light than it receives, with techniques that trace paths;
//  - caustics are missing, because no path can hit a light without extent;
//  - nothing is in view, because the bounds of all primitives are outside the view volume.
// The time is bounded for any scene. With more than 20,000 primitives, or 8 shapes around the camera, a
// warning may be missed.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan);

// Returns the warnings of a rendered image. The ray counts show exactly whether anything is in view.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan, const TraceCounts& traced);

// Returns whether the image lacks caustics because paths cannot hit a light without extent.
bool loses_caustics(const Scene& scene, const Plan& plan);

}  // namespace orrery
