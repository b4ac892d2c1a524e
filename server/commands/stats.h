#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "server/api/results.h"

// Statistics of a render command. REQUIRES: plan, stats, certificate and cost of the results are set.
namespace orrery {

// Returns the render options of the plan and the results.
nlohmann::ordered_json stats_json(const ImageResults& results);
// Returns {"version", "scene", "plan", "certificate", "cost", "budget"}. "scene" is the scene's ID, "plan" a
// query that renders the same image. "budget" is missing if there was none.
nlohmann::ordered_json certificate_file_json(const Scene& scene, const ImageResults& results);

}  // namespace orrery
