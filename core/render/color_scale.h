#pragma once

#include "core/math/vec3.h"

namespace orrery {

// The ends of the scale of errors in linear radiance: black up to the first, white from the second on.
inline constexpr double kBlackError = 1e-5, kWhiteError = 1;

// The colour of an error on that scale, which is logarithmic, as linear colour: a helix about the greys with
// lightness that always rises (Green, "A colour scheme for the display of astronomical intensity images",
// Bulletin of the Astronomical Society of India 39, 2011, with its usual start 0.5, -1.5 turns, hue 1 and
// gamma 1).
Vec3d color_of_error(double error);

}  // namespace orrery
