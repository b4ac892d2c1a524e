#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/budget/renderer.h"
#include "core/model/plan.h"

namespace orrery {

// Statistics of a render command.
struct RunStats {
  int threads = 0;
  double load_ms = 0, encode_ms = 0;
  double render_cpu_s = 0;  // CPU time of building and tracing, without loading and encoding
  RenderStats render;
  Certificate certificate = {};
  std::optional<BudgetOutcome> budget = {};
};

nlohmann::ordered_json stats_json(const Plan& plan, const RunStats& stats);
// Returns {"version", "scene", "plan", "certificate", "cost", "budget"}. "scene" is the scene's ID, "plan" a
// query that renders the same image. "budget" is missing if there was none.
nlohmann::ordered_json certificate_file_json(const Scene& scene, const Plan& plan, const RunStats& stats);
std::string stats_text(const Plan& plan, const RunStats& stats);

}  // namespace orrery
