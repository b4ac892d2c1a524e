#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/sum.h"

namespace orrery {

// Ledger of omitted light. For each pixel and channel, b is an upper bound on the change of the sum of the
// samples, in linear radiance. The planned and the full render trace the same rays up to the first omitted
// ray. From there they differ by at most the weight of the ray times the radiance that it could have found.
struct OmissionLedger {
  Sum sum = 0, squares = 0;  // sums of b and of b^2 over pixels and channels
  double largest = 0;
  double values = 0;
  int samples = 0;

  double mean() const { return values > 0 ? sum / values / samples : 0; }
  double rms() const { return values > 0 ? std::sqrt(squares / values) / samples : 0; }
  double max() const { return values > 0 ? largest / samples : 0; }

  // Adds other pixels with the same number of samples.
  void add(const OmissionLedger& other) {
    sum += other.sum;
    squares += other.squares;
    largest = std::max(largest, other.largest);
    values += other.values;
    samples = std::max(samples, other.samples);
  }
  // Adds other samples of the same pixels. The root mean square of a sum is at most the sum of the root mean
  // squares.
  void join(const OmissionLedger& other) {
    sum += other.sum;
    const double root = std::sqrt(squares) + std::sqrt(other.squares);
    squares = root * root;
    largest += other.largest;
    values = std::max(values, other.values);
    samples += other.samples;
  }
};

}  // namespace orrery
