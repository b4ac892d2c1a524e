#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// Estimates the number of rays of all kinds that a render traces, from scene and plan alone. Thread-safe and
// does not throw. REQUIRES: `plan` was returned by make_plan(). The estimate is the mean of a branching
// process of rays (Galton and Watson, 1875):
//  - Generation 0 consists of the camera rays: pixels x samples.
//  - Half of the rays of a generation hit a specular surface, if the scene has one and the technique follows
//    specular rays. Each of these rays has one child (mirrored) or, if some material is transparent, two
//    children (mirrored and refracted). Generations end at the plan's depth.
//  - The weights of two children add up to at most the weight of their parent. In each generation, at most
//    1/min_contribution descendants of a camera ray therefore have enough weight to be traced.
//  - Every other ray sends a shadow ray to each light of the scene, if the plan traces shadows.
// A path has one shadow ray per vertex, connections to its reuse group, and rays that search for emitters. At
// each vertex, 70 % of the paths continue. If diffuse surfaces end paths, half as many or none continue.
//
// The estimate is proportional to pixels and samples. If a budget may end the render early, at most 16
// samples per pixel are assumed. A pixel filter with negative lobes doubles the rays. The fraction of
// specular hits is a guess, since it depends on the view. For the sample scenes, the estimate is 0.4 to 6
// times the number of traced rays, and mostly 1 to 2 times.
double expected_rays(const Scene& scene, const Plan& plan);

// Returns the cost of one ray of this plan relative to a typical ray, which takes 20 ns on one thread. The
// cost is 1, or more if the accelerator tests every primitive for each ray. Thread-safe and does not throw.
// REQUIRES: `plan` was returned by make_plan().
double ray_weight(const Scene& scene, const Plan& plan);

}  // namespace orrery
