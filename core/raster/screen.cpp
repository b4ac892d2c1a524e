#include "core/raster/screen.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/cameras/pixel_filter.h"
#include "core/model/technique.h"
#include "core/model/tile.h"
#include "core/raster/projector.h"
#include "core/raster/tessellate.h"

namespace orrery {
namespace {

SampleRange sample_range(const Plan& plan) {
  if (plan.samples == 1) return {kSubpixels / 2, kSubpixels / 2};
  const double half =
      plan.filtered ? double{PixelFilter(*plan.asked.filter, *plan.asked.filter_width).half_width()} : 0.5;
  return {static_cast<int>(std::floor((0.5 - half) * kSubpixels)) - 1,  // samples are rounded down
          static_cast<int>(std::ceil((0.5 + half) * kSubpixels))};
}

// Pixels from lo to hi.
struct Span {
  int lo, hi;
  int size() const { return hi - lo + 1; }
  Span within(int size) const { return {std::max(lo, 0), std::min(hi, size - 1)}; }
};

// Elements of tiles in ascending order of numbers.
template <class X>
struct Unsorted {
  std::vector<X> elements;
  std::vector<std::uint32_t> tiles;

  void add(std::uint32_t tile, const X& element) {
    elements.push_back(element);
    tiles.push_back(tile);
  }
  // Counting sort.
  void sort(ByTile<X>& sorted) const {
    if (tiles.empty()) return;
    const auto [least, most] = std::minmax_element(tiles.begin(), tiles.end());
    sorted.first_tile = *least;
    sorted.first.assign(*most - *least + 2, 0);
    for (const std::uint32_t tile : tiles) ++sorted.first[tile - *least + 1];
    for (std::size_t i = 1; i < sorted.first.size(); ++i) sorted.first[i] += sorted.first[i - 1];
    sorted.elements.resize(elements.size());
    std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
    for (std::size_t i = 0; i < tiles.size(); ++i) sorted.elements[next[tiles[i] - *least]++] = elements[i];
  }
};

// Returns the batch element of a pixel in its tile.
std::uint16_t slot_of(int x, int y) {
  const int column = x % kTileSide, row = y % kTileSide;
  const int block = row / 4 * (kTileSide / 4) + column / 4;
  return static_cast<std::uint16_t>(block * 16 + row % 4 * 4 + column % 4);
}

// Finds the tiles and the samples that the triangles of a chunk cover.
class ChunkBuilder {
 public:
  ChunkBuilder(const Screen& screen, const Projector& projector, const Plan& plan, SampleRange samples)
      : screen_(screen), projector_(projector), width_(plan.width), height_(plan.height), samples_(samples) {}

  void build(std::size_t number, Screen::Chunk& chunk) {
    triangles_.elements.clear();
    triangles_.tiles.clear();
    fragments_.elements.clear();
    fragments_.tiles.clear();
    const std::size_t begin = number * Screen::kChunk;
    const std::size_t end = std::min(begin + Screen::kChunk, screen_.surfaces.triangles.size());
    find_candidates(begin, end);
    for (std::size_t i = 0; i < candidates_; ++i) {
      const std::uint32_t triangle = candidate_[i];
      if (is_beyond_guard(triangle))
        add_clipped(triangle, chunk);
      else
        add(screen_.triangle(triangle * Screen::kParts), triangle * Screen::kParts);
    }
    triangles_.sort(chunk.triangles);
    fragments_.sort(chunk.fragments);
  }

 private:
  // Triangles that cover at most this many pixels as boxes are stored as fragments.
  static constexpr int kSmall = 8;

  // Returns the pixels whose samples may be between two coordinates in subpixels.
  Span pixels(std::int32_t a, std::int32_t b, std::int32_t c) const {
    const std::int32_t lo = std::min(std::min(a, b), c), hi = std::max(std::max(a, b), c);
    return {(lo - samples_.hi + kSubpixels - 1) >> kShift, (hi - samples_.lo) >> kShift};
  }
  static constexpr int kShift = 10;
  static_assert(1 << kShift == kSubpixels);

  // Finds triangles whose boxes contain samples, and triangles to be clipped.
  void find_candidates(std::size_t begin, std::size_t end) {
    candidates_ = 0;
    const Tessellation::Triangle* const triangles = screen_.surfaces.triangles.data();
    const ScreenVertex* const vertices = screen_.vertices.get();
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = triangles[i].vertices;
      const ScreenVertex &p = vertices[a], &q = vertices[b], &r = vertices[c];
      const Span across = pixels(p.x, q.x, r.x), down = pixels(p.y, q.y, r.y);
      const bool beyond =
          (p.x == ScreenVertex::kBeyond) | (q.x == ScreenVertex::kBeyond) | (r.x == ScreenVertex::kBeyond);
      const bool covers = (across.lo <= across.hi) & (across.lo < width_) & (across.hi >= 0) &
                          (down.lo <= down.hi) & (down.lo < height_) & (down.hi >= 0);
      candidate_[candidates_] = static_cast<std::uint32_t>(i);
      candidates_ += beyond | covers;
    }
  }

  bool is_beyond_guard(std::uint32_t triangle) const {
    const auto& [a, b, c] = screen_.surfaces.triangles[triangle].vertices;
    return screen_.vertices[a].x == ScreenVertex::kBeyond || screen_.vertices[b].x == ScreenVertex::kBeyond ||
           screen_.vertices[c].x == ScreenVertex::kBeyond;
  }

  void add_clipped(std::uint32_t triangle, Screen::Chunk& chunk) {
    std::array<Vec3d, 3> positions;
    for (std::size_t i = 0; i < 3; ++i)
      positions[i] = screen_.surfaces.vertices[screen_.surfaces.triangles[triangle].vertices[i]].position;
    Screen::Number number = triangle * Screen::kParts;
    projector_.clip(positions, [&](const ScreenTriangle& part, const Screen::Corners& corners) {
      chunk.clipped.push_back({++number, part, corners});
      add(part, number);
    });
  }

  void add(const ScreenTriangle& triangle, Screen::Number number) {
    const auto& [x, y] = std::pair(triangle.x, triangle.y);
    const Span across = pixels(x[0], x[1], x[2]), down = pixels(y[0], y[1], y[2]);
    const Span columns = across.within(width_), rows = down.within(height_);
    if (screen_.centred && across.size() <= kSmall && down.size() <= kSmall &&
        across.size() * down.size() <= kSmall)
      return add_fragments(triangle, number, columns, rows);
    if (std::int64_t{x[1] - x[0]} * (y[2] - y[0]) == std::int64_t{x[2] - x[0]} * (y[1] - y[0])) return;
    if (columns.size() <= 0 || rows.size() <= 0) return;
    for (int row = rows.lo / kTileSide; row <= rows.hi / kTileSide; ++row)
      for (int column = columns.lo / kTileSide; column <= columns.hi / kTileSide; ++column)
        triangles_.add(static_cast<std::uint32_t>(row * screen_.tiles_across + column), number);
  }

  void add_fragments(const ScreenTriangle& triangle, Screen::Number number, const Span& columns,
                     const Span& rows);

  const Screen& screen_;
  const Projector& projector_;
  int width_, height_;
  SampleRange samples_;
  std::array<std::uint32_t, Screen::kChunk> candidate_;
  std::size_t candidates_ = 0;
  Unsorted<Screen::Number> triangles_;
  Unsorted<Screen::Fragment> fragments_;
};

// Computes the numbers of TileRaster::draw(), which are exact or are rounded in the same order. All edge
// functions of small triangles fit in 32 bits.
void ChunkBuilder::add_fragments(const ScreenTriangle& triangle, Screen::Number number, const Span& columns,
                                 const Span& rows) {
  const auto& [x, y] = std::pair(triangle.x, triangle.y);
  const int area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (area == 0) return;
  const int side = area < 0 ? -1 : 1;
  const int left = columns.lo * kSubpixels + kSubpixels / 2, top = rows.lo * kSubpixels + kSubpixels / 2;
  std::array<int, 3> a, b, at_row;  // edge functions at the first pixel of a row, less the least value inside
  std::array<double, 3> near;
  std::array<int, 3> least;
  const double inverse = 1.0 / (area * side);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t from = (i + 1) % 3, to = (i + 2) % 3;
    const int dx = (x[to] - x[from]) * side, dy = (y[to] - y[from]) * side;
    a[i] = -dy * kSubpixels;
    b[i] = dx * kSubpixels;
    least[i] = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
    at_row[i] = dx * (top - y[from]) - dy * (left - x[from]);
    near[i] = triangle.nearness[i] * inverse;
  }
  for (int row = rows.lo; row <= rows.hi; ++row) {
    std::array<int, 3> e = at_row;
    for (int column = columns.lo; column <= columns.hi; ++column) {
      if (((e[0] - least[0]) | (e[1] - least[1]) | (e[2] - least[2])) >= 0)
        fragments_.add(
            static_cast<std::uint32_t>(row / kTileSide * screen_.tiles_across + column / kTileSide),
            {e[0] * near[0] + e[1] * near[1] + e[2] * near[2], number, slot_of(column, row)});
      for (std::size_t i = 0; i < 3; ++i) e[i] += a[i];
    }
    for (std::size_t i = 0; i < 3; ++i) at_row[i] += b[i];
  }
}

}  // namespace

const Screen::ClippedPart& Screen::clipped(Number number) const {
  const auto& parts = chunks[number / kParts / kChunk].clipped;
  return *std::lower_bound(parts.begin(), parts.end(), number,
                           [](const ClippedPart& part, Number n) { return part.number < n; });
}

std::size_t Screen::bytes() const {
  const auto size = [](const auto& list) { return list.size() * sizeof list[0]; };
  std::size_t sum = size(surfaces.vertices) + size(surfaces.triangles);
  sum += surfaces.vertices.size() * sizeof vertices[0];
  for (const Chunk& chunk : chunks)
    sum += size(chunk.clipped) + size(chunk.triangles.elements) + size(chunk.triangles.first) +
           size(chunk.fragments.elements) + size(chunk.fragments.first);
  return sum;
}

std::shared_ptr<const Screen> make_screen(const Scene& scene, const Plan& plan) {
  auto screen = std::make_shared<Screen>();
  screen->surfaces = tessellate(scene, plan, kMaxScreenTriangles);
  screen->parallel = plan.camera->parallel();
  screen->centred = plan.samples == 1;
  screen->tiles_across = (plan.width + kTileSide - 1) / kTileSide;
  const Tessellation& surfaces = screen->surfaces;
  const SampleRange samples = sample_range(plan);
  const Projector projector(plan, samples);
  constexpr std::size_t kChunk = Screen::kChunk;
  const std::size_t vertices = surfaces.vertices.size();
  screen->vertices = std::make_unique_for_overwrite<ScreenVertex[]>(vertices);
  parallel_for_each((vertices + kChunk - 1) / kChunk, 1, [&](std::size_t c) {
    const std::size_t begin = c * kChunk, count = std::min(kChunk, vertices - begin);
    projector.project({&surfaces.vertices[begin], count}, &screen->vertices[begin]);
  });
  screen->chunks.resize((surfaces.triangles.size() + kChunk - 1) / kChunk);
  parallel_for_each(screen->chunks.size(), 1, [&](std::size_t c) {
    ChunkBuilder(*screen, projector, plan, samples).build(c, screen->chunks[c]);
  });
  return screen;
}

}  // namespace orrery
