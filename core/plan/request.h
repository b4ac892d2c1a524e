#pragma once

#include <optional>
#include <string>

#include "core/model/plan.h"

namespace orrery {

// What one render may ask beside what its scene says. Nothing given: as the scene says.
struct RenderRequest {
  std::optional<int> width, height, samples, max_depth;
  std::optional<std::string> technique, accelerator;
  std::optional<Precision> precision;
  std::optional<double> min_contribution, fov_degrees, time;
  std::optional<std::uint64_t> seed;
  std::optional<bool> reorder;
  std::optional<Prediction> prediction;
  Orbit orbit;
  bool full_model = false;  // every stage present, whatever the scene: the planned picture must equal it
  int slice = Plan{}.slice;
};

}  // namespace orrery
