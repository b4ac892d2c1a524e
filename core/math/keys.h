#pragma once

#include <algorithm>
#include <vector>

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
    const auto next =
        static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    if (next == 0) return values.front();
    const std::size_t last = next - 1;
    if (next == times.size() || times[last] == time) return values[last];
    return mix(values[last], values[next], (time - times[last]) / (times[next] - times[last]));
  }
};

}  // namespace orrery
