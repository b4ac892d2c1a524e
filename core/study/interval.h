#pragma once

#include <optional>
#include <span>

namespace orrery {

// Where the mean lies that values were drawn around, with probability 0.95: Student's t of independent normal
// values.
struct Interval {
  double low = 0, high = 0;
};

// None of fewer than two values.
std::optional<Interval> mean_interval(std::span<const double> values);

}  // namespace orrery
