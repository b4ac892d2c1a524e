#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// Estimates the number of rays that a picture traces, of all kinds, before anything of its scene is measured.
// The estimate is the mean of a branching process (Galton and Watson, 1875) of rays:
//  - Generation 0 are the camera rays: pixels x samples.
//  - Half of the rays of a generation meet a specular surface, if the scene has any and the technique follows
//    specular rays. Each of them has one child (mirrored) or, if some material is transparent, two (mirrored
//    and refracted). Generations end at the plan's depth.
//  - The weights of two children add up to at most their parent's weight. So at most 1 / min_contribution
//    descendants of a camera ray weigh enough to be traced in each generation.
//  - The other rays send a shadow ray to each light of the scene, if the plan has shadows traced.
// A path has one shadow ray per vertex, the connections to its group, and rays that search for emitters.
// Seven in ten paths continue at each vertex. The share of one half is a guess, since the actual share
// depends on the view. For the sample scenes the estimate is 0.4 to 6 times the number of rays traced, mostly
// 1 to 2 times. It is proportional to pixels and samples. If a budget chooses the samples, 16 are assumed.
double expected_rays(const Scene& scene, const Plan& plan);

// Returns the cost of one ray of this plan in usual rays of 20 ns on one thread. The weight is at least 1. It
// is higher if the accelerator tests every primitive for each ray.
double ray_weight(const Scene& scene, const Plan& plan);

}  // namespace orrery
