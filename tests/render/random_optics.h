#pragma once

#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace orrery::test {

// A scene of what trees of rays are cut in: balls, boxes and tubes of mirrors, glass, filters and matt
// materials with highlights, over a floor or not, in the light of one to four lights, in ambient light or
// none, before a background or a sky.
Json random_optics(Random& random);

}  // namespace orrery::test
