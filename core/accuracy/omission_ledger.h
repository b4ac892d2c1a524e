#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/sum.h"

namespace orrery {

// Ledger of omitted light. For each pixel and channel, b is an upper bound on the change that the omission
// causes in the sum of the samples, in linear radiance. The planned render and a render with all rays trace
// the same rays up to the first omitted ray. Their images differ by at most the weight of the omitted ray
// times the radiance that it could have found.
struct OmissionLedger {
  Sum sum = 0, squares = 0;  // sums of b and of b^2 over pixels and channels
  double largest = 0;        // largest b
  double values = 0;         // pixels times channels
  int samples = 0;           // per pixel

  double mean() const { return values > 0 ? sum / values / samples : 0; }
  double rms() const { return values > 0 ? std::sqrt(squares / values) / samples : 0; }
  double max() const { return values > 0 ? largest / samples : 0; }

  // Adds the ledger of other pixels with the same number of samples.
  void add(const OmissionLedger& other) {
    sum += other.sum;
    squares += other.squares;
    largest = std::max(largest, other.largest);
    values += other.values;
    samples = std::max(samples, other.samples);
  }
  // Adds the ledger of other samples of the same pixels. Adds square roots, because the root mean square of a
  // sum is at most the sum of the root mean squares.
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
