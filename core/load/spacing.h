#pragma once

#include "core/model/scene.h"

namespace orrery {

// Distances between the surfaces of a scene. Double-precision rays leave a few points of each primitive along
// its normal, at nine times of the scene's motion and at key times. Covers the first 256 primitives; measures
// mirrors only in scenes with no more.
struct SurfaceGaps {
  // Smallest distance between two parallel surfaces, of one body or of two.
  LocatedValue layer_distance{std::numeric_limits<double>::infinity(), ""};
  // Curved mirror with the largest error growth toward other curved mirrors: see take_mirror().
  MirrorChain mirrors;
};

// Measures the gaps. Throws Cancelled. REQUIRES: facts.magnitude is set.
SurfaceGaps measure_surface_gaps(const Scene& scene, const SceneFacts& facts);

}  // namespace orrery
