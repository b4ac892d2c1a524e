#pragma once

#include <array>
#include <cstddef>

namespace orrery {

// Values in [0, 1], kept by size: how many, and their sum, in bins of a quarter of a power of two.
class UnitHistogram {
 public:
  // Values outside of [0, 1] count as its ends. Others are rounded up to 29 bits, or to 2^-64, so that sums
  // of up to 2^24 in a bin are exact: they come in any order to the same.
  void add(double value) {
    if (value <= 0)
      bins_[0].count += 1;
    else
      add_positive(value);
  }
  void add(const UnitHistogram& other);
  // `counts` times as many values, each `values` times as large, about: of a bin, the mean is moved.
  UnitHistogram scaled(double counts, double values) const;
  double count() const;
  double mean() const;  // 0 without values

  // At least the mean of what the values were drawn from, independently, with probability 1 - delta, whatever
  // its distribution (Waudby-Smith and Ramdas, "Estimating means of bounded random variables by betting",
  // JRSS B 2024): a gambler who bets that the mean is lower, with a mixture of fixed shares of his wealth,
  // multiplies it by 1 / delta with that probability at most. Of values in a bin only the sum is known, and
  // the least wealth that they may bring counts. 1 without values.
  double upper_mean(double delta) const;
  // The least that so many values may tell: upper_mean() if all of them are 0.
  static double least_upper_mean(double count, double delta);

 private:
  static constexpr int kOctaves = 64, kPartsOfOctave = 4;
  static constexpr std::size_t kBins = kOctaves * kPartsOfOctave + 1;  // the first is of what is smaller
  struct Bin {
    double count = 0, sum = 0;
  };
  void add_positive(double value);
  void add_times(double value, double times);
  static double low_of(std::size_t bin);
  // Whether a gambler would believe that the mean is below `mean`.
  bool rejects(double mean, double log_odds) const;

  std::array<Bin, kBins> bins_{};
};

}  // namespace orrery
