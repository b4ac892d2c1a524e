#pragma once

#include <string>

#include "core/stability/row.h"

namespace orrery {

// Returns an SVG of 660 x 360 units with the names of the lines on the right. Titles of up to 65 characters
// and names of up to 28 fit. REQUIRES: each axis has a value above 0.
std::string svg_of(const LineChart& chart);

}  // namespace orrery
