#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "core/accelerators/registry.h"
#include "core/model/plan.h"
#include "core/techniques/registry.h"

namespace orrery {

inline std::vector<std::string_view> technique_names() {
  std::vector<std::string_view> names;
  for (const auto& type : technique_types()) names.push_back(type.name);
  return names;
}

// The registered structures, and "auto": the plan chooses.
inline std::vector<std::string_view> accelerator_names() {
  std::vector<std::string_view> names{"auto"};
  for (const auto& type : accelerator_types()) names.push_back(type.name);
  return names;
}

inline Precision precision_of(std::string_view name) {
  if (name == "float") return Precision::single_precision;
  if (name == "double") return Precision::double_precision;
  return Precision::automatic;
}

inline Prediction prediction_of(std::string_view name) {
  const auto found = std::find(kPredictions.begin(), kPredictions.end(), name);
  return found == kPredictions.end() ? Prediction::none
                                     : static_cast<Prediction>(found - kPredictions.begin());
}

}  // namespace orrery
