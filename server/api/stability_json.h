#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>

#include "core/stability/row.h"

namespace orrery {

// Returns {"rows": [{"id", "name", "quantity", "unit", "known": {...}, "ours": {...}, "holds"}], "holds"}.
// The outer "holds" is true if all rows hold.
nlohmann::ordered_json stability_json(std::span<const StabilityResult> results);

}  // namespace orrery
