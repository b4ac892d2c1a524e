#pragma once

#include <string>

#include "core/stability/row.h"

namespace orrery {

// Draws the lines with 660 x 360 units, and their names to the right. Titles of 65 letters and names of 28
// fit. REQUIRES: a non-zero value on each axis.
std::string svg_of(const LineChart& chart);

}  // namespace orrery
