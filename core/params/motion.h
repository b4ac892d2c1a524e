#pragma once

#include <string>

#include "core/math/keyframes.h"
#include "core/params/params.h"

namespace orrery {

inline constexpr double kMaxTime = 1e6;          // maximum absolute value of a time, seconds
inline constexpr std::size_t kMaxKeys = 10'000;  // maximum number of keyframes in a "motion" list

// Reads the list "motion" of a movable object. `read(Params&)` returns the value of one keyframe. Returns no
// keyframes if the list is missing. Records a problem in `p` if times do not increase, or if there is a
// single keyframe.
template <class Read>
auto read_motion(Params& p, const Read& read) {
  Keyframes<decltype(read(p))> keys;
  p.each("motion",
         "Keyframes, interpolated linearly: none, or at least two. Values that a keyframe omits keep the "
         "object's static value.",
         {0, kMaxKeys}, [&](Params& key) {
           const double time = key.number("time", "Time in seconds, greater than that of the previous key.",
                                          {.min = -kMaxTime, .max = kMaxTime});
           if (!keys.empty() && time <= keys.times.back())
             key.fail("time", "must be > " + number_text(keys.times.back()) +
                                  ", the time of the previous keyframe (got " + number_text(time) + ")");
           keys.times.push_back(time);
           keys.values.push_back(read(key));
         });
  if (keys.times.size() == 1) p.fail("motion", "must have no keyframes or at least 2 (got 1)");
  return keys;
}

}  // namespace orrery
