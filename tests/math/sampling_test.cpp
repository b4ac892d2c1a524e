#include "core/math/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/covers.h"

namespace orrery {
namespace {

class Stratification : public testing::TestWithParam<int> {};

// Every way of cutting the pixel into n equal boxes, n = 2^k: 1 x n, 2 x n/2, ... n x 1.
TEST_P(Stratification, PutsOneSampleIntoEachElementaryInterval) {
  const int count = GetParam();
  for (std::uint32_t stream = 0; stream < 200; ++stream) {
    for (int across = 1; across <= count; across *= 2) {
      const int down = count / across;
      std::set<std::pair<int, int>> taken;
      for (int sample = 0; sample < count; ++sample) {
        const auto p = stratified_point(static_cast<std::uint32_t>(sample), mix_bits(stream));
        taken.insert({static_cast<int>(p.u * static_cast<float>(across)),
                      static_cast<int>(p.v * static_cast<float>(down))});
      }
      EXPECT_EQ(taken.size(), static_cast<std::size_t>(count))
          << across << " x " << down << ", stream " << stream;
    }
  }
}

// Aligned blocks of the sequence are stratified as well: a picture of 4 samples continued to 16 stays so.
TEST_P(Stratification, HoldsForEveryAlignedBlock) {
  const int count = GetParam();
  const int side = static_cast<int>(std::lround(std::sqrt(count)));
  for (int block = 0; block < 16; ++block) {
    std::set<std::pair<int, int>> taken;
    for (int i = 0; i < count; ++i) {
      const auto p = stratified_point(static_cast<std::uint32_t>(block * count + i), 12345u);
      taken.insert({static_cast<int>(p.u * static_cast<float>(side)),
                    static_cast<int>(p.v * static_cast<float>(side))});
    }
    EXPECT_EQ(taken.size(), static_cast<std::size_t>(count)) << "block " << block;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Stratification, testing::Values(4, 16, 64));

TEST(Sampling, RandomBitsNeverReachOne) {
  test::covers("A33");
  for (std::uint32_t below = 0; below < 256; ++below) {
    EXPECT_LT(unit_float(0xffffffffu - below), 1.0f);
    EXPECT_GE(unit_float(below), 0.0f);
  }
  EXPECT_EQ(unit_float(0xffffffffu), 1 - 0x1p-24f);
}

TEST(Sampling, MixingAndScramblingLoseNothing) {
  std::set<std::uint32_t> mixed, scrambled, reversed;
  for (std::uint32_t i = 0; i < 65536; ++i) {
    mixed.insert(mix_bits(i));
    scrambled.insert(scramble_reversed(i, 99u));
    reversed.insert(reverse_bits(i));
    EXPECT_EQ(reverse_bits(reverse_bits(i * 2654435761u)), i * 2654435761u);
  }
  EXPECT_EQ(mixed.size(), 65536u);
  EXPECT_EQ(scrambled.size(), 65536u);
  EXPECT_EQ(reversed.size(), 65536u);
}

// Each lane gets what a number alone gets.
TEST(Sampling, LanesAreNumbers) {
  for (std::uint32_t sample = 0; sample < 300; ++sample) {
    const stdx::native_simd<std::uint32_t> streams(
        [&](std::uint32_t lane) { return mix_bits(1000 * sample + lane); });
    const auto points = stratified_point(sample, streams);
    for (std::size_t lane = 0; lane < streams.size(); ++lane) {
      const auto alone = stratified_point(sample, static_cast<std::uint32_t>(streams[lane]));
      EXPECT_EQ(points.u[lane], alone.u);
      EXPECT_EQ(points.v[lane], alone.v);
    }
  }
}

// Correlation between the samples of neighbouring streams stays below 4 standard deviations.
TEST(Sampling, StreamsAreIndependent) {
  constexpr int kPairs = 100'000;
  double sum = 0;
  for (std::uint32_t pixel = 0; pixel < kPairs; ++pixel) {
    const auto a = stratified_point(0, combine_bits(7, pixel)),
               b = stratified_point(0, combine_bits(7, pixel + 1));
    sum += (static_cast<double>(a.u) - 0.5) * (static_cast<double>(b.u) - 0.5) * 12;
  }
  EXPECT_LT(std::abs(sum) / kPairs, 4 / std::sqrt(static_cast<double>(kPairs)));
}

}  // namespace
}  // namespace orrery
