#pragma once

#include <span>
#include <vector>

#include "core/stability/row.h"

namespace orrery {

// Returns all rows, in the order of the report. The span is valid until the program exits. Thread-safe.
std::span<const StabilityRow> stability_rows();

// Returns the row with this id. Throws std::out_of_range if there is none.
const StabilityRow& stability_row(const char* id);

// Measures every row, in about a third of a second on one thread.
std::vector<StabilityResult> measure_stability();

}  // namespace orrery
