#include "core/raster/tile_raster.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

constexpr std::size_t kAhead = 8;  // triangles that are prefetched

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
[[gnu::flatten]] void TileRaster::draw(const ScreenTriangle& triangle, Screen::Number number) {
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
          const auto later = IndexLanes<double>(std::int64_t{number}) > load_index<double>(limit_number_, i);
          seen = seen && (nearness < limit_.at(i) || (nearness == limit_.at(i) && mask_cast<N>(later)));
        }
        if (none_of(seen)) continue;
        nearness_.put(i, seen, nearness);
        nearest_.put(i, mask_cast<IndexLanes<double>>(seen), IndexLanes<double>(std::int64_t{number}));
      }
}

template <bool peels>
void TileRaster::draw(const Screen::Fragment& fragment) {
  const int slot = fragment.slot;
  const double nearness = fragment.nearness;
  const std::int64_t number = fragment.number;
  if (nearness < nearness_[slot] || (nearness == nearness_[slot] && number > nearest_[slot])) return;
  if constexpr (peels)
    if (nearness > limit_[slot] || (nearness == limit_[slot] && number <= limit_number_[slot])) return;
  nearness_[slot] = nearness;
  nearest_[slot] = number;
}

template <bool peels>
void TileRaster::draw_triangles() {
  const int across = tile_.x0 / kTileSide, down = tile_.y0 / kTileSide;
  const auto tile = static_cast<std::uint32_t>(down * screen_.tiles_across + across);
  for (const Screen::Chunk& chunk : screen_.chunks) {
    checkpoint();
    const Screen::Block& block = *chunk.block;
    const std::span<const Screen::Number> numbers = chunk.triangles.of(tile);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto corners = [&](std::size_t ahead) -> const auto& {
        return block.corners[numbers[std::min(i + ahead, numbers.size() - 1)] / Screen::kParts - block.first];
      };
      __builtin_prefetch(&corners(2 * kAhead));
      for (const std::uint32_t vertex : corners(kAhead))
        __builtin_prefetch(&screen_.vertices[block.first_vertex + vertex]);
      draw<peels>(screen_.triangle(numbers[i]), numbers[i]);
    }
    for (const Screen::Fragment& fragment : chunk.fragments.of(tile)) draw<peels>(fragment);
  }
}

void TileRaster::draw(const TileView& tile, const TileSamples& samples) {
  tile_ = tile;
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

Facets::Weights TileRaster::weights(const std::array<int, Facets::kLanes>& slots) const {
  std::array<ScreenTriangle, Facets::kLanes> triangles;
  for (std::size_t lane = 0; lane < triangles.size(); ++lane)
    triangles[lane] = screen_.triangle(number(slots[lane]));
  std::array<N, 3> x, y;  // subpixels from the corner of the tile
  Vec3<N> near;
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = N([&](auto lane) { return double(triangles[lane].x[k] - tile_.x0 * kSubpixels); });
    y[k] = N([&](auto lane) { return double(triangles[lane].y[k] - tile_.y0 * kSubpixels); });
    near[k] = N([&](auto lane) { return triangles[lane].nearness[k]; });
  }
  const N at_x([&](auto lane) { return x_[slots[lane]]; }), at_y([&](auto lane) { return y_[slots[lane]]; });
  const N area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  const N side = select(area < N(0), N(-1), N(1));
  Vec3<N> weights;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = (k + 1) % 3, to = (k + 2) % 3;
    const N dx = (x[to] - x[from]) * side, dy = (y[to] - y[from]) * side;
    weights[k] = dx * (at_y - y[from]) - dy * (at_x - x[from]);  // exact
  }
  if (perspective_ && !screen_.parallel) weights = weights * near;
  weights = weights / (weights.x + weights.y + weights.z);
  for (std::size_t lane = 0; lane < triangles.size(); ++lane) {
    if (number(slots[lane]) % Screen::kParts == 0) continue;
    const Screen::Corners& corners = screen_.clipped(number(slots[lane])).corners;
    const Vec3d whole = corners[0] * double(weights.x[lane]) + corners[1] * double(weights.y[lane]) +
                        corners[2] * double(weights.z[lane]);
    weights.x[lane] = whole.x;
    weights.y[lane] = whole.y;
    weights.z[lane] = whole.z;
  }
  return weights;
}

}  // namespace orrery
