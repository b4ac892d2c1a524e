#pragma once

#include <cstddef>
#include <vector>

namespace orrery {

// Histogram of values in [0, 1]: count and sum per bin. There are four bins per power of two. An empty
// histogram allocates nothing. Const functions are thread-safe.
class UnitHistogram {
 public:
  // Adds a value, clamped to [0, 1]. Positive values are rounded up to 29 significant bits and to at least
  // 2^-64. Sums of up to 2^24 values in a bin are then exact and independent of their order.
  void add(double value) {
    if (bins_.empty()) bins_.resize(kBins);
    if (value <= 0)
      bins_[0].count += 1;
    else
      add_positive(value);
  }
  void add(const UnitHistogram& other);
  // Returns a histogram with `counts` times as many values, each `values` times as large and clamped to [0,
  // 1]. The values of a bin are replaced by their mean.
  UnitHistogram scaled(double counts, double values) const;
  double count() const;
  double mean() const;  // 0 if empty

  // Returns an upper bound of the expected value, valid with probability 1 - delta for independent values of
  // any distribution (Waudby-Smith and Ramdas, "Estimating means of bounded random variables by betting",
  // JRSS B 2024). A gambler bets on a lower mean, with a mixture of fixed fractions of the wealth. If the
  // mean is not lower, the wealth grows by a factor of 1/delta with probability at most delta. Only the count
  // and sum of a bin are known, so the lowest wealth for them counts. Returns 1 if the histogram is empty.
  double upper_mean(double delta) const;
  // Returns upper_mean() of `count` zeros, which is the smallest for `count` values.
  static double min_upper_mean(double count, double delta);

 private:
  static constexpr int kOctaves = 64, kPartsOfOctave = 4;
  static constexpr std::size_t kBins = kOctaves * kPartsOfOctave + 1;  // bin 0: values below 2^-64
  struct Bin {
    double count = 0, sum = 0;
  };
  void add_positive(double value);
  void add_times(double value, double times);
  static double low_of(std::size_t bin);  // lower end of the bin
  // Returns whether the gambler's wealth proves that the expected value is below `mean`. `log_odds` is the
  // logarithm of 1/delta.
  bool rejects(double mean, double log_odds) const;

  std::vector<Bin> bins_;  // kBins, or none if empty
};

}  // namespace orrery
