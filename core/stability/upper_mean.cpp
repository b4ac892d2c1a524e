#include <cmath>

#include "core/render/unit_histogram.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"

namespace orrery {
namespace {

// Measures how often the upper end of a 95 % interval is below the true mean, in %. A run has 256 values,
// each 1 with probability 1/2000, otherwise 0. Most runs contain only zeros.
StabilityFigures measure() {
  constexpr int kRuns = 400, kCount = 256;
  constexpr double kShare = 0.0005, kNormalQuantile = 1.645;
  StabilityFigures missed{0, 0};
  SplitMix random(1);
  for (int run = 0; run < kRuns; ++run) {
    double sum = 0;
    UnitHistogram all;
    for (int i = 0; i < kCount; ++i) {
      const double x = random.unit() < kShare ? 1 : 0;
      all.add(x);
      sum += x;  // the sum of squares is the same
    }
    const double mean = sum / kCount, variance = mean - mean * mean;
    missed.ours += all.upper_mean(0.05) < kShare;
    missed.known += mean + kNormalQuantile * std::sqrt(variance / kCount) < kShare;
  }
  return {100 * missed.known / kRuns, 100 * missed.ours / kRuns};
}

}  // namespace

StabilityRow upper_mean_row() {
  return {"certificate-26",
          "Confidence interval of a mean",
          "one-sided 95 % intervals for a mean of 1/2,000, from 256 values of 0 or 1: intervals that miss "
          "the mean",
          "%",
          "normal distribution (central limit theorem)",
          80,
          "betting (Waudby-Smith, Ramdas 2024)",
          5,
          measure};
}

}  // namespace orrery
