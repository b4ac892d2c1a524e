#pragma once

#include "core/model/plan.h"
#include "core/model/scene.h"

namespace orrery {

// Rays that a picture is expected to trace, of all kinds, before anything was measured of its scene: the mean
// of a branching process (Galton and Watson, 1875) whose individuals are rays.
//  - Generation 0 are the camera rays: pixels x samples.
//  - Half of the rays of a generation meet a specular surface, if the scene has any and the technique follows
//    them: each has one child (mirrored) or, where some material is transparent, two (mirrored and
//    refracted). Generations end at the plan's depth.
//  - The weights of two children add up to at most their parent's: of the descendants of a camera ray,
//    no more than 1 / min_contribution in each generation weigh enough to be traced.
//  - The other rays send a shadow ray to each light of the scene, if the plan has shadows traced.
// Of paths: those of one camera ray, of which seven in ten go on from each vertex, with one shadow ray a
// vertex, the connections to what others found, and looks at what shines. Half is a guess where the truth
// depends on what is seen: of the sample scenes it gives between 0.4 and 6 times what is traced, mostly 1
// to 2. Proportional to pixels and samples.
// A plan whose samples a budget chooses is taken to end at 16.
double expected_rays(const Scene& scene, const Plan& plan);

// How many rays of usual ones, which take 20 ns of a thread, take as long as one of this plan: 1, or more
// where its structure has every ray ask every primitive.
double ray_weight(const Scene& scene, const Plan& plan);

}  // namespace orrery
