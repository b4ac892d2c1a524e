#include "core/accuracy/unit_histogram.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace orrery {

void UnitHistogram::add_positive(double value) {
  constexpr std::uint64_t kRoundedOff = (std::uint64_t{1} << 24) - 1;
  const auto bits = std::bit_cast<std::uint64_t>(std::max(value, 0x1p-64));
  add_times(std::bit_cast<double>((bits + kRoundedOff) & ~kRoundedOff), 1);
}

// Computes the bin from the exponent and the two highest bits of the fraction. The four bins of an octave
// have equal widths.
void UnitHistogram::add_times(double value, double times) {
  constexpr int kBitsBelow = 50;
  constexpr std::uint64_t kFirst = std::uint64_t{1023 - kOctaves} << 2;
  const double x = value > 0 ? std::min(value, 1.0) : 0.0;
  const std::uint64_t part = std::bit_cast<std::uint64_t>(x) >> kBitsBelow;
  const std::size_t bin = part < kFirst ? 0 : std::min<std::uint64_t>(part - kFirst + 1, kBins - 1);
  bins_[bin].count += times;
  bins_[bin].sum += times * x;
}

void UnitHistogram::add(const UnitHistogram& other) {
  if (bins_.empty()) bins_.resize(other.bins_.size());
  for (std::size_t i = 0; i < other.bins_.size(); ++i) {
    bins_[i].count += other.bins_[i].count;
    bins_[i].sum += other.bins_[i].sum;
  }
}

UnitHistogram UnitHistogram::scaled(double counts, double values) const {
  UnitHistogram all;
  all.bins_.resize(bins_.size());
  for (const Bin& bin : bins_)
    if (bin.count > 0) all.add_times(values * bin.sum / bin.count, counts * bin.count);
  return all;
}

double UnitHistogram::count() const {
  double all = 0;
  for (const Bin& bin : bins_) all += bin.count;
  return all;
}

double UnitHistogram::mean() const {
  double sum = 0;
  for (const Bin& bin : bins_) sum += bin.sum;
  return sum > 0 ? sum / count() : 0;
}

double UnitHistogram::low_of(std::size_t bin) {
  if (bin == 0) return 0;
  const auto part = static_cast<int>(bin) - 1;
  return std::ldexp(1 + (part % kPartsOfOctave) / double{kPartsOfOctave}, part / kPartsOfOctave - kOctaves);
}

// Computes the wealth as a weighted mean over bets. The wealth of one bet is the product over values of 1 +
// bet (mean - value). A bet is a fraction of the largest bet that cannot ruin the gambler. Half of the wealth
// is on the largest fraction, which wins most if all values are 0. The logarithm is concave, so its chord is
// a lower bound within a bin.
bool UnitHistogram::rejects(double mean, double log_odds) const {
  constexpr int kBets = 24;
  std::array<double, kBets> wealth;
  for (int j = 0; j < kBets; ++j) {
    const double share = j == 0 ? 0.999 : std::exp2(-0.75 * j), bet = share / (1 - mean);
    double sum = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      const Bin& bin = bins_[i];
      if (bin.count == 0) continue;
      const double low = low_of(i), high = i + 1 < kBins ? low_of(i + 1) : 1;
      const double at_low = std::log1p(bet * (mean - low)), at_high = std::log1p(bet * (mean - high));
      const double along = high > low ? (bin.sum - bin.count * low) / (high - low) : 0;
      sum += bin.count * at_low + along * (at_high - at_low);
    }
    wealth[static_cast<std::size_t>(j)] = sum;
  }
  const double most = *std::max_element(wealth.begin(), wealth.end());
  double others = 0;
  for (std::size_t j = 1; j < kBets; ++j) others += std::exp(wealth[j] - most);
  const double mean_wealth = (std::exp(wealth[0] - most) + others / (kBets - 1)) / 2;
  return most + std::log(mean_wealth) >= log_odds;
}

double UnitHistogram::min_upper_mean(double count, double delta) {
  UnitHistogram zeros;
  zeros.bins_.resize(1);
  zeros.bins_[0].count = count;
  return zeros.upper_mean(delta);
}

double UnitHistogram::upper_mean(double delta) const {
  const double values = count();
  if (values == 0) return 1;
  const double log_odds = -std::log(delta);
  double kept = std::max(mean(), 1e-18), rejected = 1;  // bisected on a log scale
  if (!rejects(1 - 1e-12, log_odds)) return 1;
  while (rejected / kept > 1.001) {
    const double middle = std::sqrt(kept * rejected);
    (middle < 1 && !rejects(middle, log_odds) ? kept : rejected) = middle;
  }
  return rejected;
}

}  // namespace orrery
