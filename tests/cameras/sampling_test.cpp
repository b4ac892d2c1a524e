#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/cameras/pixel_filter.h"
#include "core/cameras/thin_lens.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

// Compares samples on lenses and in pixel filters with their densities.
namespace orrery::test {
namespace {

// Expects chi-square within 5 standard deviations of its mean, above and below. Cells with an expected count
// below 5 are skipped.
void expect_chi_square(const std::vector<double>& counts, const std::vector<double>& expected) {
  double sum = 0;
  int cells = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] < 5) continue;
    sum += std::pow(counts[i] - expected[i], 2) / expected[i];
    ++cells;
  }
  ASSERT_GT(cells, 10);
  EXPECT_NEAR(sum, cells, 5 * std::sqrt(2.0 * cells));
}

using N = Lanes<double>;

class Lens : public testing::TestWithParam<int> {};

// Grid cells that are entirely inside the aperture receive samples in proportion to their area, normalized by
// the area of the aperture.
TEST_P(Lens, SamplesApertureUniformly) {
  covers("light-24 light-25");
  const int blades = GetParam();
  const double turn = 20;
  const LensShape<double> shape({blades, turn});
  const double area = blades == 0 ? std::numbers::pi : blades / 2.0 * std::sin(2 * std::numbers::pi / blades);
  const auto within = [&](double x, double y) {
    if (blades == 0) return x * x + y * y <= 1;
    const double inner = std::cos(std::numbers::pi / blades);
    for (int side = 0; side < blades; ++side) {
      const double angle = turn * std::numbers::pi / 180 + 2 * std::numbers::pi * (side + 0.5) / blades;
      if (x * std::cos(angle) + y * std::sin(angle) > inner) return false;
    }
    return true;
  };
  constexpr int kGrid = 41, kPoints = 1 << 18;
  std::vector<double> counts(kGrid * kGrid, 0), expected(kGrid * kGrid, 0);
  Random random(5);
  int outside = 0, points = 0;
  while (points < kPoints) {
    const auto unit = [&](int) { return static_cast<double>(random.below(1 << 24)) * 0x1p-24; };
    const auto point = shape.at({N(unit), N(unit)});
    for (std::size_t lane = 0; lane < N::size(); ++lane, ++points) {
      const double x = point.right[lane], y = point.up[lane];
      outside += !within(x * (1 - 1e-12), y * (1 - 1e-12));
      const auto column = static_cast<std::size_t>((x + 1) / 2 * kGrid * (1 - 1e-12)),
                 row = static_cast<std::size_t>((y + 1) / 2 * kGrid * (1 - 1e-12));
      ++counts[row * kGrid + column];
    }
  }
  EXPECT_EQ(outside, 0);
  const auto edge = [](int i) { return 2.0 * i / kGrid - 1; };
  for (int row = 0; row < kGrid; ++row)
    for (int column = 0; column < kGrid; ++column) {
      bool inside = true;
      for (const int right : {0, 1})
        for (const int up : {0, 1}) inside = inside && within(edge(column + right), edge(row + up));
      if (inside)
        expected[static_cast<std::size_t>(row * kGrid + column)] = points * 4.0 / kGrid / kGrid / area;
    }
  expect_chi_square(counts, expected);
}

INSTANTIATE_TEST_SUITE_P(Blades, Lens, testing::Values(0, 3, 4, 5, 6, 7, 16));

// Returns the value of the filter at `x` pixels from its centre, with the filter's default width and without
// normalization. Implements the published formulas.
double height(Filter filter, double x) {
  constexpr double pi = std::numbers::pi;
  x = std::abs(x);
  switch (filter) {
    case Filter::box: return x <= 0.5;
    case Filter::gaussian: return x <= 1.5 ? std::exp(-x * x / (2 * 0.25)) : 0;
    case Filter::blackman_harris: {
      if (x > 1.5) return 0;
      const double n = x / 3 + 0.5;
      return 0.35875 - 0.48829 * std::cos(2 * pi * n) + 0.14128 * std::cos(4 * pi * n) -
             0.01168 * std::cos(6 * pi * n);
    }
    case Filter::mitchell:
      return x < 1   ? (7 * x * x * x - 12 * x * x + 16.0 / 3) / 6
             : x < 2 ? (-7.0 / 3 * x * x * x + 12 * x * x - 20 * x + 32.0 / 3) / 6
                     : 0;
    case Filter::lanczos:
      return x == 0 ? 1 : x < 3 ? std::sin(pi * x) / (pi * x) * std::sin(pi * x / 3) / (pi * x / 3) : 0;
  }
  return 0;
}

class PixelFilters : public testing::TestWithParam<Filter> {};

// The product f(x) f(y) of a filter has a positive and a negative part. The density of samples of a part is
// proportional to the part's magnitude, and the weight of the part is its integral.
TEST_P(PixelFilters, SamplesInProportionToFilterValue) {
  covers("light-24 light-25");
  const Filter filter = GetParam();
  const PixelFilter own(filter, 0);
  constexpr int kBins = 101;
  constexpr double kHalf = 3;
  std::vector<double> above(kBins, 0), below(kBins, 0);  // integral of f over each bin
  double sum_above = 0, sum_below = 0;
  for (int bin = 0; bin < kBins; ++bin)
    for (int step = 0; step < 1000; ++step) {
      const double f = height(filter, (bin + (step + 0.5) / 1000) * 2 * kHalf / kBins - kHalf);
      (f > 0 ? above : below)[static_cast<std::size_t>(bin)] += std::abs(f);
      (f > 0 ? sum_above : sum_below) += std::abs(f);
    }
  const double all = sum_above - sum_below;
  const double positive = (sum_above * sum_above + sum_below * sum_below) / (all * all),
               negative = 2 * sum_above * sum_below / (all * all);
  EXPECT_NEAR(own.positive(), positive, 1e-4);
  EXPECT_NEAR(own.negative(), negative, 1e-4);
  EXPECT_NEAR(own.positive() - own.negative(), 1, 1e-14);
  EXPECT_EQ(own.negative() > 0, has_negative_lobes(filter));
  Random random(6);
  for (const auto part : {PixelFilter::Part::positive, PixelFilter::Part::negative}) {
    const bool alike = part == PixelFilter::Part::positive;
    if (!alike && own.negative() == 0) continue;
    constexpr int kRounds = 600;
    std::vector<double> counts(kBins * kBins, 0), expected(kBins * kBins, 0);
    for (int round = 0; round < kRounds; ++round) {
      TileSamples samples;
      for (int slot = 0; slot < kBatch; ++slot) {
        samples.u[slot] = static_cast<float>(random.below(1 << 24)) * 0x1p-24f;
        samples.v[slot] = static_cast<float>(random.below(1 << 24)) * 0x1p-24f;
      }
      own.place(part, samples);
      for (int slot = 0; slot < kBatch; ++slot) {
        const auto bin = [&](float place) {
          return static_cast<std::size_t>((double{place} - 0.5 + kHalf) / (2 * kHalf) * kBins);
        };
        ++counts[bin(samples.v[slot]) * kBins + bin(samples.u[slot])];
      }
    }
    const double mass = (alike ? positive : negative) * all * all;
    for (std::size_t y = 0; y < kBins; ++y)
      for (std::size_t x = 0; x < kBins; ++x) {
        const double share =
            alike ? above[x] * above[y] + below[x] * below[y] : above[x] * below[y] + below[x] * above[y];
        expected[y * kBins + x] = share / mass * kRounds * kBatch;
      }
    expect_chi_square(counts, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, PixelFilters,
                         testing::Values(Filter::box, Filter::gaussian, Filter::blackman_harris,
                                         Filter::mitchell, Filter::lanczos));

TEST(PixelFilter, ScalesWithItsWidth) {
  const PixelFilter narrow(Filter::mitchell, 2), usual(Filter::mitchell, 0);
  TileSamples a, b;
  for (int slot = 0; slot < kBatch; ++slot)
    a.u[slot] = b.u[slot] = static_cast<float>(slot) / kBatch, a.v[slot] = b.v[slot] = 0.3f;
  narrow.place(PixelFilter::Part::negative, a);
  usual.place(PixelFilter::Part::negative, b);
  for (int slot = 0; slot < kBatch; ++slot) EXPECT_NEAR(2 * (a.u[slot] - 0.5f), b.u[slot] - 0.5f, 1e-6f);
}

}  // namespace
}  // namespace orrery::test
