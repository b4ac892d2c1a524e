#pragma once

#include <span>
#include <string>

#include "core/stability/row.h"

// Text and Markdown reports of the measured rows. Pure, thread-safe functions that throw no errors of their
// own.
namespace orrery {

// Formats a figure: "2.4e-7 m", "3.1 %", "12 of 13", "0". The unit "1" is not printed.
std::string figure_text(double value, const char* unit);

// Returns three lines per row. The first begins with its id.
std::string stability_text(std::span<const StabilityResult> results);

// Returns the page docs/stability.md. Its pictures are pictures/stability-<name of the chart>.svg.
std::string stability_markdown(std::span<const StabilityResult> results);

}  // namespace orrery
