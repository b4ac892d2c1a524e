#include "core/model/film.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace orrery::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns sums of one sample: 0.5 at the pixels of the tile, NaN elsewhere.
std::unique_ptr<TileSums> sums_of(const TileView& tile) {
  auto sums = std::make_unique<TileSums>();
  for (auto& plane : sums->radiance) plane.fill(kNan);
  for_each_slot(tile, [&](std::size_t i) {
    for (auto& plane : sums->radiance) plane[i] = 0.5;
  });
  sums->samples = 1;
  return sums;
}

TEST(Film, CountsNonFiniteValues) {
  for (const FilmStorage storage : {FilmStorage::srgb8, FilmStorage::linear32, FilmStorage::sums})
    for (const auto& [width, height] : {std::pair{kTileSide, kTileSide}, {1, 1}, {30, 17}}) {
      Film film(width, height, storage);
      const TileView tile = TileGrid(width, height).at(0, 1);
      const auto sums = sums_of(tile);
      EXPECT_EQ(film.put(tile, *sums), 0u) << width;
      sums->radiance[0][0] = kNan;
      sums->radiance[2][0] = std::numeric_limits<double>::infinity();
      EXPECT_EQ(film.put(tile, *sums), 1u) << width;
    }
}

}  // namespace
}  // namespace orrery::test
