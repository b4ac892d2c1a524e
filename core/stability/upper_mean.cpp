#include <cmath>

#include "core/accuracy/unit_histogram.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"

namespace orrery {
namespace {

// Measures the percentage of runs in which the upper end of a one-sided 95 % interval is below the true mean.
// A run has 256 values. Each value is 1 with probability 1/2000, otherwise 0. Most runs contain only zeros.
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
      sum += x;  // also the sum of squares, since x is 0 or 1
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
          "256 Bernoulli samples, mean 1/2,000: share of one-sided 95 % confidence intervals that miss the "
          "true mean",
          "%",
          "normal distribution (central limit theorem)",
          80,
          "betting (Waudby-Smith, Ramdas 2024)",
          5,
          measure};
}

}  // namespace orrery
