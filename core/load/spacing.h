#pragma once

#include "core/model/scene.h"

namespace orrery {

// How near to each other the surfaces of a scene run, measured by rays in double precision that leave a few
// points of each primitive along its normal, at nine moments of the scene's motion and at times of its keys.
// Looks at the first 256 primitives, and for mirrors at scenes of no more.
struct Spacing {
  // Smallest distance between two surfaces that run alike: the sides of one body, or those of two.
  Extreme layer_distance{std::numeric_limits<double>::infinity(), ""};
  // The curved mirror from which errors grow most toward other curved mirrors: see take_mirror().
  MirrorChain mirrors;
};

// `facts`: magnitude and bounds are known.
Spacing measure_spacing(const Scene& scene, const SceneFacts& facts);

}  // namespace orrery
