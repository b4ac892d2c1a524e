#pragma once

#include <span>
#include <string>

#include "core/stability/row.h"

// Text and Markdown reports of the measured rows. All functions are pure and thread-safe, and throw only
// std::bad_alloc.
namespace orrery {

// Formats a figure with two significant digits: "2.4e-07 m", "3.1 %", "12 of 13", "0". Figures from 100 to
// 99,999 are printed as integers. The unit "1" is not printed.
std::string figure_text(double value, const char* unit);

// Returns three lines per row, and a last line with the number of rows within their bounds. The first line of
// a row begins with the id.
std::string stability_text(std::span<const StabilityResult> results);

// Returns the page docs/stability.md, which refers to charts as pictures/stability-<name of the chart>.svg.
std::string stability_markdown(std::span<const StabilityResult> results);

}  // namespace orrery
