#include "server/commands/stats.h"

#include <nlohmann/json.hpp>

#include "core/plan/plan.h"
#include "server/api/error_report.h"
#include "server/api/option_json.h"

namespace orrery {

using nlohmann::ordered_json;

ordered_json stats_json(const ImageResults& results) {
  ordered_json json = options_json(settings_of(*results.plan));
  json.update(result_members(&ResultOutputs::stats, results));
  return json;
}

ordered_json certificate_file_json(const Scene& scene, const ImageResults& results) {
  ordered_json json = {
      {"version", 1},
      {"scene", scene.id},
      {"plan", query_of(scene, settings_of(*results.plan))},
      {"certificate", certificate_json(*results.certificate)},
      {"cost", {{"rays", results.stats->counts.rays.total()}, {"cpu_s", results.cost->render_cpu_s}}}};
  if (results.budget) json["budget"] = budget_json(*results.budget);
  return json;
}

}  // namespace orrery
