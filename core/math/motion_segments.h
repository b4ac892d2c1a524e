#pragma once

#include <algorithm>
#include <vector>

#include "core/math/lanes.h"

namespace orrery {

// Motion segments of an exposure. Assigns lanes to segments by their times, which are fractions of the
// exposure in [0, 1).
template <class T>
class MotionSegments {
 public:
  using N = Lanes<T>;

  // `moments` are in seconds, ascending. REQUIRES: the first and the last differ.
  explicit MotionSegments(const std::vector<double>& moments) {
    const double opens = moments.front(), length = moments.back() - opens;
    for (const double moment : moments) moments_.push_back(static_cast<T>((moment - opens) / length));
  }

  // Calls visit(lanes, moment, share) for each segment that contains the times of some lanes. `moment` is the
  // index of the start of the segment. `share` is the position within the segment, from 0 to 1.
  template <class Visit>
  [[gnu::always_inline]] void for_each(const N& time, const Visit& visit) const {
    MaskOf<N> open(true);
    if (moments_.size() == 2) return visit(open, std::size_t{0}, time);
    while (any(open)) {
      const auto lane = static_cast<std::size_t>(stdx::find_first_set(open));
      const auto next = std::upper_bound(moments_.begin() + 1, moments_.end() - 1, T(time[lane]));
      const T from = *std::prev(next), to = *next;
      const auto here = open && time >= N(from) && time < N(to);
      visit(here, static_cast<std::size_t>(next - moments_.begin()) - 1, N((time - N(from)) / N(to - from)));
      open = open && !here;
      open[lane] = false;
    }
  }

 private:
  std::vector<T> moments_;
};

}  // namespace orrery
