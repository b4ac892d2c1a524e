#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/sum.h"

namespace orrery {

// The ledger of a picture: how far what was left out may take the mean of a pixel's samples, over all pixels
// and channels, in linear radiance. Of each value of a pixel the sum over samples b is taken first: planned
// and full picture trace the same rays until the first that is left out, and differ there by its weight times
// what it may have found.
struct Omitted {
  Sum sum = 0, squares = 0;  // of b
  double largest = 0;
  double values = 0;
  int samples = 0;

  double mean() const { return values > 0 ? sum / values / samples : 0; }
  double rms() const { return values > 0 ? std::sqrt(squares / values) / samples : 0; }
  double max() const { return values > 0 ? largest / samples : 0; }

  // Other pixels, of the same samples.
  void add(const Omitted& other) {
    sum += other.sum;
    squares += other.squares;
    largest = std::max(largest, other.largest);
    values += other.values;
    samples = std::max(samples, other.samples);
  }
  // Other samples of the same pixels: the root of a mean square of sums is at most the sum of the roots.
  void join(const Omitted& other) {
    sum += other.sum;
    const double root = std::sqrt(squares) + std::sqrt(other.squares);
    squares = root * root;
    largest += other.largest;
    values = std::max(values, other.values);
    samples += other.samples;
  }
};

}  // namespace orrery
