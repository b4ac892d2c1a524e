#pragma once

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace orrery::test {

// Returns the random numbers of the scenes. The variable SCENES_SEED overrides the default seed.
Random scenes_seed();

// Returns a random scene for tests of truncated ray trees. Balls, boxes and tubes are above a plane or in a
// box. Their materials are mirrors, glass, filters, and matt surfaces with highlights. The scene has one to
// four lights, optional ambient light, and a constant background or a sky.
Json random_optics(Random& random);

}  // namespace orrery::test
