#pragma once

#include "core/model/scene.h"

namespace orrery {

// Distances between the surfaces of a scene, in metres. The distances are measured with double-precision rays
// along the normals at a few points of each primitive. Moving primitives are measured at nine evenly spaced
// times and at up to 16 key times. Only the first 256 primitives are measured. Mirrors are measured only in
// scenes with at most 256 primitives.
struct SurfaceGaps {
  // Smallest distance between two parallel surfaces of the same primitive or of different primitives.
  LocatedValue layer_distance{std::numeric_limits<double>::infinity(), ""};
  // Curved mirror with the largest error growth toward other curved mirrors: see take_mirror().
  MirrorChain mirrors;
  MirrorTurns turns;  // see MirrorPaths
};

// Measures the gaps. Throws Cancelled. REQUIRES: facts.magnitude is set.
SurfaceGaps measure_surface_gaps(const Scene& scene, const SceneFacts& facts);

}  // namespace orrery
