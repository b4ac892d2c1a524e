#include "core/model/draws.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/covers.h"

namespace orrery::test {
namespace {

template <class T>
SamplePoint<double> draw(const Draws& draws, SampleSet set, int depth, int slot) {
  const auto point = draws.two<T>(set, depth, IndexLanes<T>(static_cast<IndexOf<T>>(slot)));
  return {static_cast<double>(point.u[0]), static_cast<double>(point.v[0])};
}

// Pixels in the overlap of two tiles have the same random numbers in both tiles.
TEST(Draws, DependsOnPixelNotTile) {
  const Draws whole(7, TileView{0, 0, kTileSide, kTileSide}, 3);
  const Draws beside(7, TileView{16, 8, kTileSide, kTileSide}, 3);
  for (int slot = 0; slot < kBatch; ++slot) {
    const auto [x, y] = tile_pixel(slot);
    if (x < 16 || y < 8) continue;
    for (int other = 0; other < kBatch; ++other) {
      if (tile_pixel(other).x != x - 16 || tile_pixel(other).y != y - 8) continue;
      const auto a = draw<float>(whole, SampleSet::lobe, 1, slot),
                 b = draw<float>(beside, SampleSet::lobe, 1, other);
      ASSERT_EQ(a.u, b.u);
      ASSERT_EQ(a.v, b.v);
    }
  }
}

TEST(Draws, AgreesInFloatAndDouble) {
  const Draws draws(1, TileView{32, 0, kTileSide, kTileSide}, 9);
  for (int slot = 0; slot < kBatch; slot += 11) {
    const auto a = draw<float>(draws, SampleSet::light, 2, slot),
               b = draw<double>(draws, SampleSet::light, 2, slot);
    EXPECT_EQ(a.u, b.u);
    EXPECT_EQ(a.v, b.v);
  }
}

// Draws the numbers of some tiles and samples, then draws them again in reverse order from new objects.
TEST(Draws, IsIndependentOfEarlierDraws) {
  covers("light-3");
  constexpr int kTiles = 3, kSamples = 5, kDepths = 3;
  const auto numbers_of = [](int tile, int sample, int depth, int slot) {
    const Draws draws(5, TileView{kTileSide * tile, kTileSide, kTileSide, kTileSide}, sample);
    const auto lobe = draw<double>(draws, SampleSet::lobe, depth, slot);
    const auto lane = IndexLanes<double>(static_cast<IndexOf<double>>(slot));
    return std::array{lobe.u, lobe.v, double{draws.third<double>(SampleSet::lens, depth, lane)[0]}};
  };
  std::vector<std::array<double, 3>> forward;
  for (int tile = 0; tile < kTiles; ++tile)
    for (int sample = 0; sample < kSamples; ++sample)
      for (int depth = 0; depth < kDepths; ++depth)
        for (int slot = 0; slot < kBatch; slot += 7) forward.push_back(numbers_of(tile, sample, depth, slot));
  std::size_t left = forward.size();
  for (int tile = kTiles; tile-- > 0;)
    for (int sample = kSamples; sample-- > 0;)
      for (int depth = kDepths; depth-- > 0;)
        for (int slot = (kBatch - 1) / 7 * 7; slot >= 0; slot -= 7)
          ASSERT_EQ(numbers_of(tile, sample, depth, slot), forward[--left]);
}

// Each sample set, depth and frame has its own sequence. The correlation of two sequences over the pixels of
// a tile stays within 4 standard deviations of 0.
TEST(Draws, IsUncorrelatedAcrossSetsDepthsAndFrames) {
  const TileView tile{0, 0, kTileSide, kTileSide};
  TileView later = tile;
  later.frame = 1;
  const Draws now(1, tile, 0), then(1, later, 0);
  const std::vector<std::function<double(int)>> all = {
      [&](int slot) { return draw<float>(now, SampleSet::pixel, 0, slot).u; },
      [&](int slot) { return draw<float>(now, SampleSet::lobe, 0, slot).u; },
      [&](int slot) { return draw<float>(now, SampleSet::light, 0, slot).u; },
      [&](int slot) { return draw<float>(now, SampleSet::lobe, 1, slot).u; },
      [&](int slot) { return draw<float>(then, SampleSet::pixel, 0, slot).u; }};
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      double sum = 0;
      for (int slot = 0; slot < kBatch; ++slot) sum += (all[a](slot) - 0.5) * (all[b](slot) - 0.5);
      EXPECT_LT(std::abs(sum * 12 / std::sqrt(double{kBatch})), 4) << a << " and " << b;
    }
}

// On average, a quarter of the 256 samples is in the lower half of both sets, as for independent samples. If
// both sets had the same order, this fraction would vary with a standard deviation of .25 between pixels.
TEST(Draws, CoversProductOfTwoSets) {
  covers("light-2");
  constexpr int kSamples = 256, kPixels = 64;
  const std::array sets{SampleSet::pixel, SampleSet::light, SampleSet::lobe, SampleSet::lens};
  for (const SampleSet a : sets)
    for (const SampleSet b : sets) {
      if (a == b) continue;
      double sum = 0, squares = 0;
      for (int pixel = 0; pixel < kPixels; ++pixel) {
        int both = 0;
        for (int sample = 0; sample < kSamples; ++sample) {
          const Draws draws(1, TileView{0, 0, kTileSide, kTileSide}, sample);
          both += draw<double>(draws, a, 0, pixel).u < 0.5 && draw<double>(draws, b, 0, pixel).u < 0.5;
        }
        const double share = static_cast<double>(both) / kSamples;
        sum += share / kPixels;
        squares += share * share / kPixels;
      }
      EXPECT_NEAR(sum, 0.25, 0.01);
      EXPECT_LE(std::sqrt(squares - sum * sum), 0.03);
    }
}

}  // namespace
}  // namespace orrery::test
