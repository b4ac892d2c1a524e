#include "core/raster/screen.h"

#include <cmath>

#include "core/base/parallel.h"
#include "core/cameras/pixel_filter.h"
#include "core/model/technique.h"
#include "core/model/tile.h"
#include "core/raster/tessellate.h"

namespace orrery {
namespace {

constexpr std::size_t kChunk = 16'384;  // triangles that one task projects
// Triangles are clipped to this distance from the edges of the image, in pixels, so that edge functions stay
// below 2^53.
constexpr double kGuard = 4096;

// Vertex in camera coordinates: to the right, up and ahead, in metres.
struct CameraVertex {
  Vec3d at;
  std::int32_t x = 0, y = 0;  // subpixels
  bool in_guard = false;
};

// Corner of a clipped polygon, and the weights of the corners of its triangle.
struct ClippedCorner {
  Vec3d at, weights;
};

// Range of the sample positions of a pixel: TileSamples::u and v.
struct SampleRange {
  double lo, hi;
};
SampleRange sample_range(const Plan& plan) {
  if (plan.samples == 1) return {0.5, 0.5};
  const double half =
      plan.filtered ? double{PixelFilter(*plan.asked.filter, *plan.asked.filter_width).half_width()} : 0.5;
  return {0.5 - half - 1.0 / kSubpixels, 0.5 + half};  // samples are rounded down to subpixels
}

// Pixels or tiles from lo to hi.
struct Span {
  int lo, hi;
};

class Projector {
 public:
  explicit Projector(const Plan& plan)
      : frame_(plan.frame),
        parallel_(plan.camera->parallel()),
        width_(plan.width),
        height_(plan.height),
        scale_(plan.height / (2 * plan.frame.half_extent)),
        samples_(sample_range(plan)) {}

  CameraVertex vertex(const Vec3d& position) const {
    const Vec3d from_eye = position - frame_.eye;
    CameraVertex vertex{{dot(from_eye, frame_.right), dot(from_eye, frame_.up), -dot(from_eye, frame_.back)}};
    bool inside = vertex.at.z > 0;
    for (int side = 0; side < 4; ++side) inside = inside && beyond_guard(vertex.at, side) >= 0;
    vertex.in_guard = inside;
    if (inside) place(vertex.at, vertex.x, vertex.y);
    return vertex;
  }

  // Adds the part of the triangle that is inside the guard region.
  void add(const std::array<const CameraVertex*, 3>& corners, std::uint32_t number,
           Screen::Chunk& chunk) const {
    if (outside_image(corners)) return;
    if (corners[0]->in_guard && corners[1]->in_guard && corners[2]->in_guard) {
      ScreenTriangle triangle;
      triangle.triangle = number;
      for (std::size_t i = 0; i < 3; ++i) {
        triangle.x[i] = corners[i]->x;
        triangle.y[i] = corners[i]->y;
        triangle.nearness[i] = nearness(corners[i]->at);
      }
      if (covers_samples(triangle)) chunk.triangles.push_back(triangle);
      return;
    }
    std::vector<ClippedCorner> polygon{
        {corners[0]->at, {1, 0, 0}}, {corners[1]->at, {0, 1, 0}}, {corners[2]->at, {0, 0, 1}}};
    for (int side = 0; side < 5; ++side) polygon = clipped(polygon, side);
    for (std::size_t i = 2; i < polygon.size(); ++i)
      add_clipped({polygon[0], polygon[i - 1], polygon[i]}, number, chunk);
  }

  // Sorts the triangles of the chunk by tile.
  void sort(Screen::Chunk& chunk) const {
    const TileGrid grid(width_, height_);
    chunk.first.assign(static_cast<std::size_t>(grid.size()) + 1, 0);
    for (const ScreenTriangle& triangle : chunk.triangles)
      for_each_tile(triangle, [&](std::size_t tile) { ++chunk.first[tile + 1]; });
    for (std::size_t tile = 1; tile < chunk.first.size(); ++tile) chunk.first[tile] += chunk.first[tile - 1];
    chunk.list.resize(chunk.first.back());
    std::vector<std::uint32_t> next(chunk.first.begin(), chunk.first.end() - 1);
    for (std::uint32_t i = 0; i < chunk.triangles.size(); ++i)
      for_each_tile(chunk.triangles[i], [&](std::size_t tile) { chunk.list[next[tile]++] = i; });
  }

 private:
  // Returns the distance of a point, in pixels at depth 1, to the inside of a side of the guard region.
  // Sides: left, right, top, bottom, and the plane of the eye.
  double beyond_guard(const Vec3d& at, int side) const {
    if (side == 4) return at.z;
    const double half = (side < 2 ? width_ : height_) / 2.0 + kGuard, depth = parallel_ ? 1 : at.z;
    const double along = (side < 2 ? at.x : at.y) * scale_;
    return half * depth + (side % 2 == 0 ? along : -along);
  }

  // Returns whether the corners are all beyond one side of the image, or behind the eye.
  bool outside_image(const std::array<const CameraVertex*, 3>& corners) const {
    const double right = width_ / 2.0 + reach(), top = height_ / 2.0 + reach();
    bool left_of = true, right_of = true, above = true, below = true, behind = true;
    for (const CameraVertex* corner : corners) {
      const Vec3d& at = corner->at;
      const double x = at.x * scale_, y = at.y * scale_, depth = parallel_ ? 1 : at.z;
      left_of = left_of && x < -right * depth;
      right_of = right_of && x > right * depth;
      below = below && y < -top * depth;
      above = above && y > top * depth;
      behind = behind && at.z <= 0;
    }
    return left_of || right_of || above || below || behind;
  }
  double reach() const { return samples_.hi; }  // largest distance of samples from the image, pixels

  // Sutherland, Hodgman, "Reentrant polygon clipping" (1974). New corners are computed from the inner to the
  // outer end of an edge, so that triangles that share the edge get equal corners.
  std::vector<ClippedCorner> clipped(const std::vector<ClippedCorner>& polygon, int side) const {
    std::vector<ClippedCorner> inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const ClippedCorner &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
      const double a = beyond_guard(from.at, side), b = beyond_guard(to.at, side);
      if (a >= 0) inside.push_back(from);
      if ((a >= 0) == (b >= 0)) continue;
      const ClippedCorner &in = a >= 0 ? from : to, &out = a >= 0 ? to : from;
      const double share = a >= 0 ? a / (a - b) : b / (b - a);
      inside.push_back({in.at + (out.at - in.at) * share, in.weights + (out.weights - in.weights) * share});
    }
    return inside;
  }

  void add_clipped(const std::array<ClippedCorner, 3>& corners, std::uint32_t number,
                   Screen::Chunk& chunk) const {
    ScreenTriangle triangle;
    triangle.triangle = number;
    triangle.clipped = static_cast<std::int32_t>(chunk.corners.size());
    for (std::size_t i = 0; i < 3; ++i) {
      if (!parallel_ && !(corners[i].at.z > 0)) return;  // the triangle touches the eye
      place(corners[i].at, triangle.x[i], triangle.y[i]);
      triangle.nearness[i] = nearness(corners[i].at);
    }
    if (!covers_samples(triangle)) return;
    chunk.triangles.push_back(triangle);
    chunk.corners.push_back({corners[0].weights, corners[1].weights, corners[2].weights});
  }

  void place(const Vec3d& at, std::int32_t& x, std::int32_t& y) const {
    const double scale = parallel_ ? scale_ : scale_ / at.z;
    x = static_cast<std::int32_t>(std::nearbyint((at.x * scale + width_ / 2.0) * kSubpixels));
    y = static_cast<std::int32_t>(std::nearbyint((height_ / 2.0 - at.y * scale) * kSubpixels));
  }
  double nearness(const Vec3d& at) const { return parallel_ ? -at.z : 1 / at.z; }

  // Returns the pixels whose samples may be between two coordinates in subpixels.
  Span pixels(const std::array<std::int32_t, 3>& at, int size) const {
    const auto [lo, hi] = std::minmax({at[0], at[1], at[2]});
    return {std::max(0, static_cast<int>(std::ceil(double(lo) / kSubpixels - samples_.hi))),
            std::min(size - 1, static_cast<int>(std::floor(double(hi) / kSubpixels - samples_.lo)))};
  }
  bool covers_samples(const ScreenTriangle& triangle) const {
    const Span across = pixels(triangle.x, width_), down = pixels(triangle.y, height_);
    if (across.lo > across.hi || down.lo > down.hi) return false;
    const auto& [x, y] = std::pair(triangle.x, triangle.y);
    return std::int64_t{x[1] - x[0]} * (y[2] - y[0]) != std::int64_t{x[2] - x[0]} * (y[1] - y[0]);
  }
  template <class Visit>
  void for_each_tile(const ScreenTriangle& triangle, const Visit& visit) const {
    const Span across = pixels(triangle.x, width_), down = pixels(triangle.y, height_);
    const int tiles_across = (width_ + kTileSide - 1) / kTileSide;
    for (int row = down.lo / kTileSide; row <= down.hi / kTileSide; ++row)
      for (int column = across.lo / kTileSide; column <= across.hi / kTileSide; ++column)
        visit(static_cast<std::size_t>(row * tiles_across + column));
  }

  const CameraFrame& frame_;
  bool parallel_;
  int width_, height_;
  double scale_;  // pixels per metre, at depth 1 m unless parallel
  SampleRange samples_;
};

}  // namespace

std::size_t Screen::bytes() const {
  const auto size = [](const auto& list) { return list.size() * sizeof list[0]; };
  std::size_t sum = size(surfaces.vertices) + size(surfaces.triangles);
  for (const Chunk& chunk : chunks)
    sum += size(chunk.triangles) + size(chunk.corners) + size(chunk.first) + size(chunk.list);
  return sum;
}

std::shared_ptr<const Screen> make_screen(const Scene& scene, const Plan& plan) {
  auto screen = std::make_shared<Screen>();
  screen->surfaces = tessellate(scene, plan, kMaxScreenTriangles);
  screen->parallel = plan.camera->parallel();
  screen->tiles_across = (plan.width + kTileSide - 1) / kTileSide;
  const Tessellation& surfaces = screen->surfaces;
  const Projector projector(plan);
  std::vector<CameraVertex> vertices(surfaces.vertices.size());
  parallel_for_each(vertices.size(), kChunk,
                    [&](std::size_t i) { vertices[i] = projector.vertex(surfaces.vertices[i].position); });
  screen->chunks.resize((surfaces.triangles.size() + kChunk - 1) / kChunk);
  parallel_for_each(screen->chunks.size(), 1, [&](std::size_t c) {
    Screen::Chunk& chunk = screen->chunks[c];
    const std::size_t end = std::min((c + 1) * kChunk, surfaces.triangles.size());
    for (std::size_t i = c * kChunk; i < end; ++i) {
      const auto& [a, b, d] = surfaces.triangles[i].vertices;
      projector.add({&vertices[a], &vertices[b], &vertices[d]}, static_cast<std::uint32_t>(i), chunk);
    }
    projector.sort(chunk);
  });
  return screen;
}

}  // namespace orrery
