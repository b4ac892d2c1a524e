#pragma once

#include "core/model/draws.h"

namespace orrery {

// Sets the times of camera rays, as fractions of the exposure: uniform in [0, 1) and stratified together with
// the lens points of the same sample set (Cook, Porter, Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984).
template <class T>
void draw_times(const Draws& draws, SampleSet set, RayBatch<T>& rays) {
  const IndexLanes<T> lane([](int i) { return static_cast<IndexOf<T>>(i); });
  for (int i = 0; i < kBatch; i += kWidth<T>)
    rays.time.put(i, draws.third<T>(set, 0, lane + static_cast<IndexOf<T>>(i)));
}

// Sets all rays to the middle of the exposure.
template <class T>
void put_middle_time(RayBatch<T>& rays) {
  rays.time.values.fill(T(0.5));
}

}  // namespace orrery
