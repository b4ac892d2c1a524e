#pragma once

#include <span>

#include "core/stages/prediction.h"

namespace orrery {

// Shadow ray and the primitive that it hit, or kNoPrimitive.
struct OcclusionSample {
  Ray<double> ray;
  int occluder;
};

// Returns a small network trained on these samples. It chooses among the primitives that occlude most of
// them. The same samples give the same network on every machine.
template <class T>
PredictorPtr<T> network_predictor(std::span<const OcclusionSample> samples);

}  // namespace orrery
