#pragma once

namespace orrery {

// Time interval in which the shutter is open, in seconds. The exposure is an instant if both times are equal.
struct Exposure {
  double opens = 0, closes = 0;

  Exposure() = default;
  Exposure(double instant) : opens(instant), closes(instant) {}
  Exposure(double first, double last) : opens(first), closes(last) {}
  bool instant() const { return !(closes > opens); }
  bool operator==(const Exposure&) const = default;
};

}  // namespace orrery
