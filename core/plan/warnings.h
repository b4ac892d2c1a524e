#pragma once

#include <vector>

#include "core/base/error.h"
#include "core/model/counts.h"
#include "core/model/plan.h"
#include "core/model/scene.h"

// Warnings about valid scenes whose image is probably not as intended. Pointers refer to the scene document.
// All functions are thread-safe. find_warnings() throws Cancelled; no function throws InputError.
namespace orrery {

// Returns the warnings that are known before rendering:
//  - Scene::notes;
//  - every surface is black: there is no light source, ambient light or emission, no background or
//    environment that a mirror shows, and no environment that lights surfaces;
//  - the eye is inside a closed opaque shape that hides every light source and, if there is ambient light or
//    emission, contains no other primitive;
//  - a material reflects over 100.5 % of the light, if TechniqueType::draws_light is true;
//  - caustics are missing, see loses_caustics();
//  - a body scatters light inside, but the technique does not, or no light enters because all such bodies
//    have smooth surfaces and no sampled direction can hit a light;
//  - nothing is in view, because the bounds of all primitives are outside the view volume. Not tested if the
//    shutter is open for longer than an instant.
// The time is bounded for any scene. With more than 20,000 primitives, or more than 8 shapes around the eye,
// a warning may be missed.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan);

// Returns the warnings of a rendered image. Nothing is in view if no camera ray of `traced` hit a primitive.
// The other warnings are those of the overload above.
std::vector<Problem> find_warnings(const Scene& scene, const Plan& plan, const TraceCounts& traced);

// Returns whether the image lacks caustics of a light without extent: no path can hit the light, the
// technique traces interreflections with a depth of at least 2, and the scene has a specular and a lit
// material.
bool loses_caustics(const Scene& scene, const Plan& plan);

}  // namespace orrery
