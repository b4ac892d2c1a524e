#include "core/accuracy/tile_halves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/image/srgb.h"
#include "tests/support/random.h"

// Compares the statistics of one tile with their definition, computed pixel by pixel.
namespace orrery::test {
namespace {

constexpr int kSamples = 8;

struct Sums {
  std::array<TileSums::Plane, 3> first, all;
};

// Returns sums of samples with values up to 2, above the display range, and one NaN.
std::unique_ptr<Sums> random_sums(std::uint64_t seed) {
  Random random(seed);
  auto sums = std::make_unique<Sums>();
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < kBatch; ++i) {
      sums->first[c][i] = random.between(0, kSamples);
      sums->all[c][i] = sums->first[c][i] + random.between(0, kSamples);
    }
  sums->first[1][0] = std::numeric_limits<double>::quiet_NaN();
  return sums;
}

class TileHalvesTest : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  const TileView tile_{.x0 = 0, .y0 = 0, .width = GetParam().first, .height = GetParam().second};
  const std::unique_ptr<Sums> sums_ = random_sums(static_cast<std::uint64_t>(tile_.width));
  const TileHalves halves_{tile_, sums_->first, sums_->all, kSamples};

  // Calls visit(slot, channel, mean of the first half, mean of the second half) for each pixel of the tile
  // that is in the image.
  template <class Visit>
  void for_each_value(const Visit& visit) const {
    for (int slot = 0; slot < kBatch; ++slot) {
      if (tile_pixel(slot).x >= tile_.width || tile_pixel(slot).y >= tile_.height) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(slot);
        const double first = sums_->first[c][i] * 2 / kSamples, both = sums_->all[c][i] * 2 / kSamples;
        visit(slot, c, first, both - first);
      }
    }
  }
};

TEST_P(TileHalvesTest, MatchesErrorOfPixelsAndBlocks) {
  double squares = 0, values = 0, block_squares = 0, blocks = 0, tile_sums[3]{};
  std::array<std::array<double, 3>, kBatch / 16> sums{}, counts{};
  for_each_value([&](int slot, std::size_t c, double a, double b) {
    if (!std::isfinite(a)) return;
    const double d = (a - b) / 2;
    squares += d * d;
    ++values;
    sums[static_cast<std::size_t>(slot / 16)][c] += d;
    ++counts[static_cast<std::size_t>(slot / 16)][c];
    tile_sums[c] += d;
  });
  for (std::size_t block = 0; block < sums.size(); ++block)
    for (std::size_t c = 0; c < 3; ++c) {
      if (counts[block][c] < 16) continue;
      block_squares += std::pow(sums[block][c] / 16, 2);
      ++blocks;
    }
  const SampledError told = halves_.error();
  EXPECT_EQ(told.samples, kSamples);
  EXPECT_EQ(told.pixel.values, values);
  EXPECT_NEAR(told.pixel.squares, squares, 1e-9 * squares);
  EXPECT_EQ(told.block4.values, blocks);
  EXPECT_NEAR(told.block4.squares, block_squares, 1e-9 * block_squares);
  EXPECT_EQ(told.block32.values, tile_.is_whole() ? 3 : 0);
  if (tile_.is_whole()) {
    const double means = std::pow(tile_sums[0], 2) + std::pow(tile_sums[1], 2) + std::pow(tile_sums[2], 2);
    EXPECT_NEAR(told.block32.squares, means / kBatch / kBatch, 1e-9 * means);
  }
  EXPECT_EQ(told.tiles, 1);
  EXPECT_NEAR(told.tile_sum, squares / values, 1e-9);
}

TEST_P(TileHalvesTest, MatchesRadianceDifference) {
  Plan plan;
  plan.sample_range = 2;
  double sum = 0, pixels = 0, of_pixel = 0;
  for_each_value([&](int, std::size_t c, double a, double b) {
    of_pixel = c == 0 ? 0 : of_pixel;
    of_pixel += std::pow((a - b) / plan.sample_range, 2) / 3;
    if (c < 2 || !std::isfinite(of_pixel)) return;
    sum += of_pixel;
    ++pixels;
  });
  Halves told;
  halves_.add_to(told, plan);
  EXPECT_NEAR(told.mean(), sum / pixels, 1e-9);
}

TEST_P(TileHalvesTest, MatchesDisplayedDifference) {
  Plan plan;
  plan.space = Space::display;
  double sum = 0, pixels = 0, of_pixel = 0;
  for_each_value([&](int, std::size_t c, double a, double b) {
    const double shown_a = encode_srgb(a), shown_b = encode_srgb(b);
    const double bias = encode_srgb((a + b) / 2) - (shown_a + shown_b) / 2;
    of_pixel = c == 0 ? 0 : of_pixel;
    of_pixel += std::pow(shown_a - shown_b, 2) + std::pow(4 * bias, 2);
    if (c < 2) return;
    sum += std::min(1.0, of_pixel / 3);
    ++pixels;
  });
  Halves told;
  halves_.add_displayed_to(told, plan);
  EXPECT_NEAR(told.mean(), sum / pixels, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(TileHalves, TileHalvesTest,
                         ::testing::Values(std::pair(kTileSide, kTileSide), std::pair(30, 17),
                                           std::pair(1, kTileSide), std::pair(3, 1)),
                         [](const auto& of) {
                           return std::to_string(of.param.first) + "x" + std::to_string(of.param.second);
                         });

}  // namespace
}  // namespace orrery::test
