#pragma once

#include <algorithm>
#include <vector>

#include "core/math/exposure.h"

namespace orrery {

// Keyframed value. Between two keys, the value is mix(before, after, share) with 0 < share < 1. Before the
// first key and after the last key, the value is constant.
template <class V>
struct Keyframes {
  std::vector<double> times;  // seconds, ascending
  std::vector<V> values;      // one per time

  bool empty() const { return times.empty(); }

  // Returns the value at `time`. REQUIRES: !empty().
  V at(double time) const {
    return between(time,
                   [](const V& before, const V& after, double share) { return mix(before, after, share); });
  }

  // Returns the value at `time`, interpolated by `mix_two` instead of mix(). REQUIRES: !empty().
  template <class Mix>
  V between(double time, const Mix& mix_two) const {
    const auto next =
        static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (next == 0) return values.front();
    const std::size_t last = next - 1;
    if (next == times.size() || times[last] == time) return values[last];
    return mix_two(values[last], values[next], (time - times[last]) / (times[next] - times[last]));
  }

  // Returns the times that divide an exposure into motion segments: the start, the keys within the exposure,
  // and the end.
  std::vector<double> moments(const Exposure& exposure) const {
    std::vector<double> all{exposure.opens};
    for (const double time : times)
      if (time > exposure.opens && time < exposure.closes) all.push_back(time);
    all.push_back(exposure.closes);
    return all;
  }
};

}  // namespace orrery
