#pragma once

#include <cstdint>
#include <span>

namespace orrery {

// Error of an image x relative to a reference r, over all channels of linear colour. d = x - r.
struct Difference {
  double rmse = 0;               // sqrt(mean d^2)
  double relative_mse = 0;       // mean of d^2 / (r + 0.01)^2; bright pixels have less weight
  double mean_absolute = 0;      // mean |d|
  double largest = 0;            // max |d|
  double bias = 0;               // mean d
  double cut_mse = 0;            // mean d^2 of x and r clamped to 0..1
  std::uint64_t non_finite = 0;  // values not finite in x or r, excluded from the above
};

// Compares two images. Thread-safe. REQUIRES: both have the same number of values.
Difference difference(std::span<const float> picture, std::span<const float> reference);

}  // namespace orrery
