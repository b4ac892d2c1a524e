#pragma once

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace orrery::test {

// Returns a random scene for tests of truncated ray trees. Balls, boxes and tubes are mirrors, glass, filters
// or matt with highlights, over a plane or a box. It has one to four lights, optional ambient light, and a
// constant background or a sky.
Json random_optics(Random& random);

}  // namespace orrery::test
