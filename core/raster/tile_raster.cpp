#include "core/raster/tile_raster.h"

#include <cmath>
#include <tuple>

#include "core/base/prefetch.h"
#include "core/base/task_scope.h"

namespace orrery {
namespace {

constexpr std::uint32_t kAhead = 8;  // triangles that are prefetched

}  // namespace

TileRaster::Edges TileRaster::edges_of(const ScreenTriangle& triangle) const {
  const auto x = [&](std::size_t i) { return double(triangle.x[i % 3] - tile_.x0 * kSubpixels); };
  const auto y = [&](std::size_t i) { return double(triangle.y[i % 3] - tile_.y0 * kSubpixels); };
  const double area = (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0));
  const double side = area < 0 ? -1 : 1;
  Edges edges;
  edges.area = area * side;
  for (std::size_t i = 0; i < 3; ++i) {
    const double dx = (x(i + 2) - x(i + 1)) * side, dy = (y(i + 2) - y(i + 1)) * side;
    edges.a[i] = -dy;
    edges.b[i] = dx;
    edges.c[i] = dy * x(i + 1) - dx * y(i + 1);
    edges.least[i] = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
  }
  return edges;
}

template <bool peels>
[[gnu::flatten]] void TileRaster::draw(const ScreenTriangle& triangle, std::int64_t number) {
  const Edges edges = edges_of(triangle);
  const auto pixels = [&](const std::array<std::int32_t, 3>& at, int corner, int size) {
    const auto [lo, hi] = std::minmax({at[0], at[1], at[2]});
    const double from = lo - corner * kSubpixels - reach_, to = hi - corner * kSubpixels + reach_;
    return std::pair(std::max(0, static_cast<int>(std::floor(from / kSubpixels - 0.5)) + 1),
                     std::min(size - 1, static_cast<int>(std::floor(to / kSubpixels - 0.5))));
  };
  const auto [left, right] = pixels(triangle.x, tile_.x0, tile_.width);
  const auto [top, bottom] = pixels(triangle.y, tile_.y0, tile_.height);
  const auto& [a, b, c] = std::tie(edges.a, edges.b, edges.c);
  std::array<double, 3> near;
  const double inverse = 1 / edges.area;
  for (std::size_t i = 0; i < 3; ++i) near[i] = triangle.nearness[i] * inverse;
  constexpr int kBlocks = kTileSide / 4;
  for (int row = top / 4; row <= bottom / 4; ++row)
    for (int column = left / 4; column <= right / 4; ++column)
      for (int within = 0; within < 16; within += kWidth<double>) {
        if (row * 4 + (within + kWidth<double> - 1) / 4 < top || row * 4 + within / 4 > bottom) continue;
        const int i = (row * kBlocks + column) * 16 + within;
        const N x = x_.at(i), y = y_.at(i);
        const N e0 = a[0] * x + b[0] * y + c[0], e1 = a[1] * x + b[1] * y + c[1],
                e2 = a[2] * x + b[2] * y + c[2];
        const N nearness = e0 * near[0] + e1 * near[1] + e2 * near[2];
        auto seen = e0 >= edges.least[0] && e1 >= edges.least[1] && e2 >= edges.least[2] &&
                    nearness > nearness_.at(i);
        if constexpr (peels) {
          const auto later = IndexLanes<double>(number) > load_index<double>(limit_number_, i);
          seen = seen && (nearness < limit_.at(i) || (nearness == limit_.at(i) && mask_cast<N>(later)));
        }
        if (none_of(seen)) continue;
        nearness_.put(i, seen, nearness);
        nearest_.put(i, mask_cast<IndexLanes<double>>(seen), IndexLanes<double>(number));
      }
}

template <bool peels>
void TileRaster::draw_triangles() {
  const int across = tile_.x0 / kTileSide, down = tile_.y0 / kTileSide;
  const auto number = static_cast<std::size_t>(down * screen_.tiles_across + across);
  for (std::size_t c = 0; c < screen_.chunks.size(); ++c) {
    const Screen::Chunk& chunk = screen_.chunks[c];
    checkpoint();
    const std::uint32_t end = chunk.first[number + 1];
    for (std::uint32_t i = chunk.first[number]; i < end; ++i) {
      prefetch_lines(chunk.triangles[chunk.list[std::min(i + kAhead, end - 1)]]);
      draw<peels>(chunk.triangles[chunk.list[i]], static_cast<std::int64_t>(c << 32 | chunk.list[i]));
    }
  }
}

void TileRaster::draw(const TileView& tile, const TileSamples& samples) {
  tile_ = tile;
  known_ = -1;
  reach_ = 0;
  for (int slot = 0; slot < kBatch; ++slot) {
    const auto place = [&](int pixel, float within) {
      reach_ = std::max(reach_, std::fabs(within - 0.5) * kSubpixels + 1);
      return std::floor((pixel + double{within}) * kSubpixels);
    };
    const TilePixel pixel = tile_pixel(slot);
    x_[slot] = place(pixel.x, samples.u[slot]);
    y_[slot] = place(pixel.y, samples.v[slot]);
    nearness_[slot] = -std::numeric_limits<double>::infinity();
    nearest_[slot] = -1;
  }
  draw_triangles<false>();
}

void TileRaster::peel(const std::array<bool, kBatch>& wanted) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  for (int slot = 0; slot < kBatch; ++slot) {
    limit_[slot] = wanted[static_cast<std::size_t>(slot)] ? nearness_[slot] : kNone;
    limit_number_[slot] = nearest_[slot];
    nearness_[slot] = kNone;
    nearest_[slot] = -1;
  }
  draw_triangles<true>();
}

Vec3d TileRaster::weights(int slot) {
  const ScreenTriangle& triangle = found(slot);
  if (known_ != nearest_[slot]) edges_ = edges_of(triangle);
  known_ = nearest_[slot];
  Vec3d weights;
  for (std::size_t i = 0; i < 3; ++i)
    weights[i] = edges_.a[i] * x_[slot] + edges_.b[i] * y_[slot] + edges_.c[i];
  if (perspective_ && !screen_.parallel)
    for (std::size_t i = 0; i < 3; ++i) weights[i] *= triangle.nearness[i];
  weights = weights / (weights.x + weights.y + weights.z);
  if (triangle.clipped < 0) return weights;
  const Screen::Corners& corners = chunk_of(slot).corners[static_cast<std::size_t>(triangle.clipped)];
  return corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
}

}  // namespace orrery
