#include "server/api/stability_json.h"

#include <nlohmann/json.hpp>

namespace orrery {

nlohmann::ordered_json stability_json(std::span<const StabilityResult> results) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool all_hold = true;
  for (const auto& [row, figures] : results) {
    const bool holds = StabilityResult{row, figures}.holds();
    all_hold = all_hold && holds;
    rows.push_back(
        {{"id", row.id},
         {"name", row.name},
         {"quantity", row.quantity},
         {"unit", row.unit},
         {"known", {{"method", row.known}, {"error", figures.known}, {"at_least", row.known_at_least}}},
         {"ours", {{"method", row.ours}, {"error", figures.ours}, {"at_most", row.ours_at_most}}},
         {"holds", holds}});
  }
  return {{"rows", rows}, {"holds", all_hold}};
}

}  // namespace orrery
