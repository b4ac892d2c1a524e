#pragma once

#include <span>

#include "core/stages/prediction.h"

namespace orrery {

// A shadow ray, and the primitive that it met, or kNoPrimitive.
struct OcclusionSample {
  Ray<double> ray;
  int occluder;
};

// A small network, trained on these samples, that chooses among the primitives that stood in the way of most
// of them. The same for the same samples, wherever it is made.
template <class T>
PredictorPtr<T> network_predictor(std::span<const OcclusionSample> samples);

}  // namespace orrery
