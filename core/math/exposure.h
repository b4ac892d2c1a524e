#pragma once

namespace orrery {

// Interval in which the shutter is open, in seconds. An instant if it closes when it opens.
struct Exposure {
  double opens = 0, closes = 0;

  Exposure() = default;
  Exposure(double instant) : opens(instant), closes(instant) {}
  Exposure(double first, double last) : opens(first), closes(last) {}
  bool instant() const { return !(closes > opens); }
  bool operator==(const Exposure&) const = default;
};

}  // namespace orrery
