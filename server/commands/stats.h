#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/model/plan.h"
#include "core/render/renderer.h"

namespace orrery {

// What a render did and what it cost.
struct RunStats {
  int threads = 0;
  double load_ms = 0, encode_ms = 0;
  double render_cpu_s = 0;  // while rendering: building included, loading and encoding not
  RenderStats render;
  Certificate certificate = {};
  std::optional<BudgetOutcome> budget = {};
};

nlohmann::ordered_json stats_json(const Plan& plan, const RunStats& stats);
// {"version", "scene", "plan", "certificate", "cost", "budget"}: the scene's id, a query that gives the
// picture again, what is promised of it, what it took, and what became of its budget, if it had one.
nlohmann::ordered_json certificate_file_json(const Scene& scene, const Plan& plan, const RunStats& stats);
std::string stats_text(const Plan& plan, const RunStats& stats);

}  // namespace orrery
