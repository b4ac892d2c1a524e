#pragma once

#include <span>

#include "core/occlusion/prediction.h"

namespace orrery {

// Shadow ray and the primitive that it hit, or kNoPrimitive.
struct OcclusionSample {
  Ray<double> ray;
  int occluder;
};

// Returns a predictor with a small network, trained on these samples. The predictor proposes one of the 15
// primitives that occlude the most samples, or none. The same samples give the same network on every machine.
template <class T>
PredictorPtr<T> network_predictor(std::span<const OcclusionSample> samples);

}  // namespace orrery
