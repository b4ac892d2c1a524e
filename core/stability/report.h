#pragma once

#include <span>
#include <string>

#include "core/stability/row.h"

// The measured rows for people to read.
namespace orrery {

// "2.4e-7 m", "3.1 %", "12 of 13", "0"; of the unit "1" the number alone.
std::string figure_text(double value, const char* unit);

// Lines that each begin with an id; three a row.
std::string stability_text(std::span<const StabilityResult> results);

// The page docs/stability.md, whose pictures are pictures/stability-<name of the chart>.svg.
std::string stability_markdown(std::span<const StabilityResult> results);

}  // namespace orrery
