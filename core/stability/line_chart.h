#pragma once

#include <string>

#include "core/stability/row.h"

namespace orrery {

// A drawing of 660 x 360 of the lines, named beside them. Titles of 65 letters and names of 28 fit. REQUIRES:
// a point other than 0 on each axis.
std::string svg_of(const LineChart& chart);

}  // namespace orrery
