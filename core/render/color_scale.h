#pragma once

#include "core/math/vec3.h"

namespace orrery {

// Range of the colour scale of errors, in linear radiance: black at or below kBlackError, white at or above
// kWhiteError.
inline constexpr double kBlackError = 1e-5, kWhiteError = 1;

// Returns the linear colour of an error in radiance, on a logarithmic scale. NaN is white. The colours form a
// helix around the grey axis with increasing lightness (Green, "A colour scheme for the display of
// astronomical intensity images", Bulletin of the Astronomical Society of India 39, 2011). The parameters are
// Green's defaults: start 0.5, -1.5 turns, hue 1 and gamma 1.
Vec3d color_of_error(double error);

}  // namespace orrery
