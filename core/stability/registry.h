#pragma once

#include <span>
#include <vector>

#include "core/stability/row.h"

namespace orrery {

std::span<const StabilityRow> stability_rows();

// Returns the row with this id. Throws std::out_of_range if there is none.
const StabilityRow& stability_row(const char* id);

// Measures every row, in about a third of a second on one thread.
std::vector<StabilityResult> measure_stability();

}  // namespace orrery
