#include "core/math/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "tests/support/covers.h"

namespace orrery {
namespace {

using Point = SamplePoint<float> (*)(std::uint32_t sample, std::uint32_t stream);
SamplePoint<float> in_order(std::uint32_t sample, std::uint32_t stream) {
  return scrambled_point(sample, stream);
}
SamplePoint<float> shuffled(std::uint32_t sample, std::uint32_t stream) {
  return stratified_point(sample, stream);
}
struct Sequence {
  int count;
  Point point;
};

class Stratification : public testing::TestWithParam<Sequence> {};

// Divides the pixel into n = 2^k equal boxes in every way: 1 x n, 2 x n/2, ... n x 1.
TEST_P(Stratification, PutsOneSampleIntoEachElementaryInterval) {
  const int count = GetParam().count;
  for (std::uint32_t stream = 0; stream < (count > 64 ? 4u : 200u); ++stream) {
    for (int across = 1; across <= count; across *= 2) {
      const int down = count / across;
      std::set<std::pair<int, int>> taken;
      for (int sample = 0; sample < count; ++sample) {
        const auto p = GetParam().point(static_cast<std::uint32_t>(sample), mix_bits(stream));
        taken.insert({static_cast<int>(p.u * static_cast<float>(across)),
                      static_cast<int>(p.v * static_cast<float>(down))});
      }
      EXPECT_EQ(taken.size(), static_cast<std::size_t>(count))
          << across << " x " << down << ", stream " << stream;
    }
  }
}

// Aligned blocks of the sequence are also stratified: a render of 4 samples per pixel that continues to 16
// stays stratified.
TEST_P(Stratification, StratifiesEveryAlignedBlock) {
  const int count = GetParam().count;
  const int side = static_cast<int>(std::lround(std::sqrt(count)));
  for (int block = 0; block < 16; ++block) {
    std::set<std::pair<int, int>> taken;
    for (int i = 0; i < count; ++i) {
      const auto p = GetParam().point(static_cast<std::uint32_t>(block * count + i), 12345u);
      taken.insert({static_cast<int>(p.u * static_cast<float>(side)),
                    static_cast<int>(p.v * static_cast<float>(side))});
    }
    EXPECT_EQ(taken.size(), static_cast<std::size_t>(count)) << "block " << block;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Stratification,
                         testing::Values(Sequence{4, in_order}, Sequence{16, in_order},
                                         Sequence{64, in_order}, Sequence{4, shuffled},
                                         Sequence{16, shuffled}, Sequence{64, shuffled},
                                         Sequence{4096, shuffled}));

// In every aligned block of 64 samples, the third dimension has one sample in each interval of length 1/64.
// Jointly with the other two, each elementary box of volume 1/32 contains two samples.
TEST(Sampling, StratifiesThirdDimensionJointly) {
  test::covers("light-1");
  constexpr std::uint32_t kCount = 64;
  for (std::uint32_t stream = 0; stream < 32; ++stream)
    for (std::uint32_t block = 0; block < 4; ++block)
      for (std::uint32_t across = 1; across <= kCount / 2; across *= 2)
        for (std::uint32_t down = 1; across * down <= kCount / 2; down *= 2) {
          const std::uint32_t deep = kCount / 2 / across / down;
          std::map<std::array<std::uint32_t, 3>, int> boxes;
          std::set<std::uint32_t> alone;
          for (std::uint32_t i = block * kCount; i < (block + 1) * kCount; ++i) {
            const auto p = stratified_point(i, mix_bits(stream));
            const float third = stratified_third(i, mix_bits(stream));
            const auto cell = [](float x, std::uint32_t n) {
              return static_cast<std::uint32_t>(x * static_cast<float>(n));
            };
            ++boxes[{cell(p.u, across), cell(p.v, down), cell(third, deep)}];
            alone.insert(cell(third, kCount));
          }
          EXPECT_EQ(boxes.size(), kCount / 2);
          EXPECT_TRUE(
              std::all_of(boxes.begin(), boxes.end(), [](const auto& box) { return box.second == 2; }));
          EXPECT_EQ(alone.size(), kCount);
        }
}

TEST(Sampling, KeepsRandomNumbersBelowOne) {
  test::covers("A33");
  for (std::uint32_t below = 0; below < 256; ++below) {
    EXPECT_LT(unit_float(0xffffffffu - below), 1.0f);
    EXPECT_GE(unit_float(below), 0.0f);
  }
  EXPECT_EQ(unit_float(0xffffffffu), 1 - 0x1p-24f);
}

TEST(Sampling, MixesAndScramblesBijectively) {
  std::set<std::uint32_t> mixed, scrambled, reversed;
  for (std::uint32_t i = 0; i < 65536; ++i) {
    mixed.insert(mix_bits(i));
    scrambled.insert(scramble_reversed<std::uint32_t>(i, 99u));
    reversed.insert(reverse_bits(i));
    EXPECT_EQ(reverse_bits(reverse_bits(i * 2654435761u)), i * 2654435761u);
  }
  EXPECT_EQ(mixed.size(), 65536u);
  EXPECT_EQ(scrambled.size(), 65536u);
  EXPECT_EQ(reversed.size(), 65536u);
}

TEST(Sampling, MatchesScalarResultsInLanes) {
  for (std::uint32_t sample = 0; sample < 300; ++sample) {
    const stdx::native_simd<std::uint32_t> streams(
        [&](std::uint32_t lane) { return mix_bits(1000 * sample + lane); });
    const auto points = stratified_point(sample, streams);
    for (std::size_t lane = 0; lane < streams.size(); ++lane) {
      const auto alone = stratified_point(sample, static_cast<std::uint32_t>(streams[lane]));
      EXPECT_EQ(points.u[lane], alone.u);
      EXPECT_EQ(points.v[lane], alone.v);
      EXPECT_EQ(stratified_third(sample, streams)[lane],
                stratified_third(sample, static_cast<std::uint32_t>(streams[lane])));
    }
  }
}

// Returns the root-mean-square error over 64 streams of an integral's estimate from the first `count`
// samples.
template <class F>
double rms_error(const F& f, double exact, int count) {
  double squares = 0;
  for (std::uint32_t stream = 0; stream < 64; ++stream) {
    double sum = 0;
    for (int sample = 0; sample < count; ++sample) {
      const auto p = stratified_point(static_cast<std::uint32_t>(sample), mix_bits(stream + 77));
      sum += f(double{p.u}, double{p.v});
    }
    squares += std::pow(sum / count - exact, 2) / 64;
  }
  return std::sqrt(squares);
}

TEST(Sampling, ConvergesAsPower3Over2ForSmoothIntegrals) {
  test::covers("light-4");
  const auto f = [](double u, double v) { return std::exp(-u - v); };
  const double exact = std::pow(1 - std::exp(-1), 2);
  const double e64 = rms_error(f, exact, 64), e256 = rms_error(f, exact, 256),
               e1024 = rms_error(f, exact, 1024);
  EXPECT_NEAR(e64 / 3.6e-4, 1, 0.25);
  EXPECT_NEAR(e256 / 5.7e-5, 1, 0.25);
  EXPECT_NEAR(e1024 / 8.7e-6, 1, 0.25);
  EXPECT_LE(std::log(e1024 / e64) / std::log(16), -1.3);
}

TEST(Sampling, ConvergesAsPower3Over4AtEdges) {
  test::covers("light-5");
  const auto f = [](double u, double v) { return u * u + v * v < 1 ? 1.0 : 0.0; };
  const double e64 = rms_error(f, std::numbers::pi / 4, 64), e1024 = rms_error(f, std::numbers::pi / 4, 1024);
  EXPECT_NEAR(e1024 / 2.6e-3, 1, 0.25);
  const double slope = std::log(e1024 / e64) / std::log(16);
  EXPECT_LE(slope, -0.65);
  EXPECT_GE(slope, -0.80);
}

// The correlation between samples of neighbouring streams stays within 4 standard deviations of 0.
TEST(Sampling, KeepsStreamsUncorrelated) {
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
