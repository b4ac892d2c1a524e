#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// Estimates the number of rays of all kinds that a render traces, from scene and plan alone. The estimate is
// the mean of a branching process (Galton and Watson, 1875) of rays:
//  - Generation 0 consists of the camera rays: pixels x samples.
//  - Half of the rays of a generation hit a specular surface, if the scene has any and the technique follows
//    specular rays. Each of them has one child (mirrored) or, if some material is transparent, two (mirrored
//    and refracted). Generations end at the plan's depth.
//  - The weights of two children add up to at most their parent's weight. So in each generation, at most 1 /
//    min_contribution descendants of a camera ray have enough weight to be traced.
//  - The other rays send a shadow ray to each light of the scene, if the plan traces shadows.
// A path has one shadow ray per vertex, connections to its reuse group, and rays that search for emitters.
// Seventy percent of the paths continue at each vertex. The fraction of one half is a guess, since the actual
// fraction depends on the view. For the sample scenes, the estimate is 0.4 to 6 times the number of traced
// rays, and mostly 1 to 2 times. It is proportional to pixels and samples. If a budget may end the render
// early, at most 16 samples per pixel are assumed.
double expected_rays(const Scene& scene, const Plan& plan);

// Returns the cost of one ray of this plan relative to a typical ray, which takes 20 ns on one thread. The
// result is at least 1. It is higher if the accelerator tests every primitive for each ray.
double ray_weight(const Scene& scene, const Plan& plan);

}  // namespace orrery
