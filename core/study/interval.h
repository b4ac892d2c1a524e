#pragma once

#include <optional>
#include <span>

namespace orrery {

// 95 % confidence interval of a mean, by Student's t for independent, normally distributed values.
struct Interval {
  double low = 0, high = 0;
};

// Returns the interval of the mean of the values, or nullopt for fewer than two values.
std::optional<Interval> mean_interval(std::span<const double> values);

}  // namespace orrery
