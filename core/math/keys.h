#pragma once

#include <algorithm>
#include <vector>

#include "core/math/exposure.h"

namespace orrery {

// A value that changes with time: what it is at some moments, its keys. Between two keys it is
// mix(before, after, share), 0 < share < 1; outside of all it rests as the nearest.
template <class V>
struct Keys {
  std::vector<double> times;  // seconds, ascending
  std::vector<V> values;      // as many

  bool empty() const { return times.empty(); }

  // REQUIRES: !empty().
  V at(double time) const {
    return between(time,
                   [](const V& before, const V& after, double share) { return mix(before, after, share); });
  }

  // The same with another mix.
  template <class Mix>
  V between(double time, const Mix& mix_two) const {
    const auto next =
        static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (next == 0) return values.front();
    const std::size_t last = next - 1;
    if (next == times.size() || times[last] == time) return values[last];
    return mix_two(values[last], values[next], (time - times[last]) / (times[next] - times[last]));
  }

  // The moments of an exposure between which the value is on its way from one to the next: the first, the
  // last, and the keys within.
  std::vector<double> moments(const Exposure& exposure) const {
    std::vector<double> all{exposure.opens};
    for (const double time : times)
      if (time > exposure.opens && time < exposure.closes) all.push_back(time);
    all.push_back(exposure.closes);
    return all;
  }
};

}  // namespace orrery
