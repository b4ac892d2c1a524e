#pragma once

#include <span>
#include <vector>

#include "core/stability/row.h"

namespace orrery {

std::span<const StabilityRow> stability_rows();

// The row of that id. Throws std::out_of_range.
const StabilityRow& stability_row(const char* id);

// Every row, measured: about a third of a second of one thread.
std::vector<StabilityResult> measure_stability();

}  // namespace orrery
