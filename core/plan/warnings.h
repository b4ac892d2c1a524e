#pragma once

#include <vector>

#include "core/base/error.h"
#include "core/model/counts.h"
#include "core/model/plan.h"
#include "core/model/scene.h"

// Why a picture shows nothing useful although nothing is wrong with its scene. Pointers are into the scene.
namespace orrery {

// What is known before the picture is rendered:
//  - no light reaches any surface: no light source, no ambient light, no emission;
//  - the camera is inside a closed opaque shape that holds no light and, where there is ambient light or
//    emission, nothing else;
//  - paths cannot find what a light without extent throws on other surfaces by way of a smooth one;
//  - nothing is in view, because the boxes of all primitives are outside of what the camera sees.
// Time: bounded, whatever the scene; of more than 20,000 primitives, or 8 shapes around the camera, it may
// miss one.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan);

// Likewise of a picture for which so much was traced: whether anything is in view is then known exactly.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan, const TraceCounts& traced);

// Whether paths cannot find what a light without extent throws on other surfaces by way of a smooth one.
bool loses_caustics(const Scene& scene, const Plan& plan);

}  // namespace orrery
