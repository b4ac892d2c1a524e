#include "server/rendering/orbit_budget.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "server/api/error_report.h"

namespace orrery {

void OrbitBudget::add(const Scene& scene, const RenderResult& frame, OrbitPath& path) {
  const int number = next_++;
  bounds_[static_cast<std::size_t>(number)] = frame.certificate.total();
  if (frame.budget) {
    of_first_ = frame.budget;
    plan_ = query_of(scene, frame.budget->settings);
    return path.continue_with(frame.budget->settings);
  }
  if (!of_first_ || of_first_->error == 0 || keeps_error(number)) return;
  BudgetOutcome missed = *of_first_;
  missed.error_met = false;
  missed.reason = "frame " + std::to_string(number) +
                  " with the settings of the first frame has an error of " +
                  (at(number).rms ? "up to " + rounded(*at(number).rms) : "unknown size");
  require_met(missed, frame.certificate);
}

bool OrbitBudget::keeps_error(int frame) const { return at(frame).rms && *at(frame).rms <= of_first_->error; }

nlohmann::ordered_json OrbitBudget::json(int frames) const {
  if (!of_first_) return nullptr;
  nlohmann::ordered_json json = budget_json(*of_first_);
  json["plan"] = plan_;
  int frames_met = 0;
  std::optional<double> largest = 0;
  for (int i = 0; i < frames; ++i) {
    frames_met += keeps_error(i);
    const auto& rms = at(i).rms;
    largest = largest && rms ? std::optional(std::max(*largest, *rms)) : std::nullopt;
  }
  json["frames_met"] =
      of_first_->error > 0 ? nlohmann::ordered_json(frames_met) : nlohmann::ordered_json(nullptr);
  json["largest_bound"] = largest ? nlohmann::ordered_json(*largest) : nlohmann::ordered_json(nullptr);
  return json;
}

}  // namespace orrery
