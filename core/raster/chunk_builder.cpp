#include "core/raster/chunk_builder.h"

#include <algorithm>

#include "core/math/compress.h"
#include "core/model/tile.h"

namespace orrery {
namespace {

constexpr int kShift = 10;
static_assert(1 << kShift == kSubpixels);

// Returns the batch element of a pixel in its tile.
std::uint16_t slot_of(int x, int y) {
  const int column = x % kTileSide, row = y % kTileSide;
  const int block = row / 4 * (kTileSide / 4) + column / 4;
  return static_cast<std::uint16_t>(block * 16 + row % 4 * 4 + column % 4);
}

}  // namespace

template <class X>
ByTile<X> Unsorted<X>::sorted() const {
  ByTile<X> result;
  if (tiles.empty()) return result;
  const auto [least, most] = std::minmax_element(tiles.begin(), tiles.end());
  result.first_tile = *least;
  result.first.assign(*most - *least + 2, 0);
  for (const std::uint32_t tile : tiles) ++result.first[tile - result.first_tile + 1];
  for (std::size_t i = 1; i < result.first.size(); ++i) result.first[i] += result.first[i - 1];
  result.elements.resize(elements.size());
  std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
  for (std::size_t i = 0; i < tiles.size(); ++i)
    result.elements[next[tiles[i] - result.first_tile]++] = elements[i];
  return result;
}

ChunkBuilder::ChunkBuilder(const Screen& screen, const Projector& projector, const Plan& plan,
                           const SampleRange& samples)
    : screen_(screen), projector_(projector), width_(plan.width), height_(plan.height), samples_(samples) {}

void ChunkBuilder::build(std::uint32_t begin, std::uint32_t end, Screen::Chunk& chunk) {
  triangles_ = {};
  fragments_ = {};
  if (screen_.centred) {
    fragments_.elements.reserve(end - begin);
    fragments_.tiles.reserve(end - begin);
  }
  block_ = chunk.block;
  vertices_ = &screen_.vertices[block_->first_vertex];
  for (std::uint32_t i = begin; i < end; i += kLanes) add_lanes(i, end, chunk);
  chunk.triangles = triangles_.sorted();
  chunk.fragments = fragments_.sorted();
}

template <class N>
ChunkBuilder::Span<N> ChunkBuilder::pixels(const std::array<N, 3>& at) const {
  using std::max, std::min;
  const N lo = min(min(at[0], at[1]), at[2]), hi = max(max(at[0], at[1]), at[2]);
  return {N((lo - samples_.hi + (kSubpixels - 1)) >> kShift), N((hi - samples_.lo) >> kShift)};
}

void ChunkBuilder::add_lanes(std::uint32_t first, std::uint32_t end, Screen::Chunk& chunk) {
  Lane lane;
  for (std::uint32_t k = 0; k < kLanes; ++k)
    lane.corners[k] = &block_->corners[std::min(first + k, end - 1) - block_->first];
  I::mask_type beyond(false);
  for (std::size_t k = 0; k < 3; ++k) {
    lane.x[k] = I([&](auto i) { return vertices_[(*lane.corners[i])[k]].x; });
    lane.y[k] = I([&](auto i) { return vertices_[(*lane.corners[i])[k]].y; });
    beyond = beyond || lane.x[k] == I(ScreenVertex::kBeyond);
  }
  const Span<I> across = pixels(lane.x), down = pixels(lane.y);
  lane.across = {max(across.lo, I(0)), min(across.hi, I(width_ - 1))};
  lane.down = {max(down.lo, I(0)), min(down.hi, I(height_ - 1))};
  const I::mask_type present =
      I([](auto k) { return static_cast<int>(k); }) < I(static_cast<int>(end - first));
  const I::mask_type covers = lane.across.lo <= lane.across.hi && lane.down.lo <= lane.down.hi;
  const I::mask_type fits = across.hi - across.lo < I(kSmall) && down.hi - down.lo < I(kSmall);
  const I::mask_type small = present && covers && fits && !beyond && I::mask_type(screen_.centred);
  for (unsigned bits = bits_of(present && (covers || beyond) && !small); bits != 0; bits &= bits - 1)
    add(first + static_cast<std::uint32_t>(std::countr_zero(bits)), chunk);
  if (any(small)) add_fragments(first, lane, small);
}

// Computes the numbers of TileRaster::draw(), which are exact or are rounded in the same order.
void ChunkBuilder::add_fragments(std::uint32_t first, const Lane& lane, const I::mask_type& small) {
  std::array<I, 3> x, y;
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = select(small, lane.x[k], I(0));
    y[k] = select(small, lane.y[k], I(0));
  }
  const I area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  const I side = select(area < I(0), I(-1), I(1));
  const I left = lane.across.lo * kSubpixels + kSubpixels / 2,
          top = lane.down.lo * kSubpixels + kSubpixels / 2;
  std::array<I, 3> a, b, row,
      least;  // edge functions at the first pixel of a row, less the least value inside
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = (k + 1) % 3, to = (k + 2) % 3;
    const I dx = (x[to] - x[from]) * side, dy = (y[to] - y[from]) * side;
    a[k] = -dy * kSubpixels;
    b[k] = dx * kSubpixels;
    least[k] = select(dy < I(0) || (dy == I(0) && dx > I(0)), I(0), I(1));
    row[k] = dx * (top - y[from]) - dy * (left - x[from]) - least[k];
  }
  const I twice_area = area * side;
  const I columns = select(small && area != I(0), lane.across.hi - lane.across.lo + 1, I(0));
  const I rows = lane.down.hi - lane.down.lo + 1;
  const int most_columns = stdx::hmax(columns), most_rows = stdx::hmax(select(small, rows, I(0)));
  for (int down = 0; down < most_rows; ++down) {
    std::array<I, 3> e = row;
    for (int across = 0; across < most_columns; ++across) {
      const auto covered = (e[0] | e[1] | e[2]) >= I(0) && I(across) < columns && I(down) < rows;
      for (unsigned bits = bits_of(covered); bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
        const double inverse = 1.0 / twice_area[i];
        const auto part = [&](std::size_t k) {
          return (e[k][i] + least[k][i]) * (vertices_[(*lane.corners[i])[k]].nearness * inverse);
        };
        const int column = lane.across.lo[i] + across, line = lane.down.lo[i] + down;
        fragments_.add(
            static_cast<std::uint32_t>(line / kTileSide * screen_.tiles_across + column / kTileSide),
            {part(0) + part(1) + part(2), (first + i) * Screen::kParts, slot_of(column, line)});
      }
      for (std::size_t k = 0; k < 3; ++k) e[k] += a[k];
    }
    for (std::size_t k = 0; k < 3; ++k) row[k] += b[k];
  }
}

void ChunkBuilder::add(std::uint32_t triangle, Screen::Chunk& chunk) {
  const auto& corners = block_->corners[triangle - block_->first];
  const bool beyond = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t vertex) {
    return vertices_[vertex].x == ScreenVertex::kBeyond;
  });
  Screen::Number number = triangle * Screen::kParts;
  if (!beyond) return add_to_tiles(screen_.triangle(number), number);
  std::array<Vec3d, 3> positions;
  for (std::size_t k = 0; k < 3; ++k) positions[k] = block_->positions[corners[k]];
  projector_.clip(positions, [&](const ScreenTriangle& part, const Screen::Corners& weights) {
    chunk.clipped.push_back({++number, part, weights});
    add_to_tiles(part, number);
  });
}

void ChunkBuilder::add_to_tiles(const ScreenTriangle& triangle, Screen::Number number) {
  const auto& [x, y] = std::pair(triangle.x, triangle.y);
  if (std::int64_t{x[1] - x[0]} * (y[2] - y[0]) == std::int64_t{x[2] - x[0]} * (y[1] - y[0])) return;
  const Span<int> across = pixels(x), down = pixels(y);
  const int left = std::max(across.lo, 0), right = std::min(across.hi, width_ - 1);
  const int top = std::max(down.lo, 0), bottom = std::min(down.hi, height_ - 1);
  if (left > right || top > bottom) return;
  for (int row = top / kTileSide; row <= bottom / kTileSide; ++row)
    for (int column = left / kTileSide; column <= right / kTileSide; ++column)
      triangles_.add(static_cast<std::uint32_t>(row * screen_.tiles_across + column), number);
}

}  // namespace orrery
