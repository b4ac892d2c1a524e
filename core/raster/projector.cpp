#include "core/raster/projector.h"

namespace orrery {
namespace {

// Triangles are clipped to this distance from the edges of the image, in pixels, so that edge functions stay
// below 2^53.
constexpr double kGuard = 4096;

}  // namespace

Projector::Projector(const Plan& plan, const SampleRange& samples)
    : frame_(plan.frame),
      parallel_(plan.camera->parallel()),
      width_(plan.width),
      height_(plan.height),
      scale_(plan.height / (2 * plan.frame.half_extent)),
      reach_(double(samples.hi) / kSubpixels) {}

void Projector::project(const Strided<Vec3d>& from, std::size_t begin, std::size_t end,
                        ScreenVertex* to) const {
  using N = Lanes<double>;
  std::size_t i = begin;
  for (; i + N::size() <= end; i += N::size())
    project(Vec3<N>(N([&](auto k) { return from[i + k].x; }), N([&](auto k) { return from[i + k].y; }),
                    N([&](auto k) { return from[i + k].z; })),
            to + i);
  for (; i < end; ++i) project(from[i], to + i);
}

template <class N>
void Projector::project(const Vec3<N>& position, ScreenVertex* to) const {
  const Vec3<N> at = in_camera(position);
  auto inside = at.z > N(0);
  for (int side = 0; side < 4; ++side) inside = inside && beyond_guard(at, side) >= N(0);
  N x, y;
  place(at, x, y);
  x = select(inside, x, N(ScreenVertex::kBeyond));
  y = select(inside, y, N(0));
  const N near = nearness(at);
  if constexpr (std::is_arithmetic_v<N>)
    *to = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), near};
  else
    for (std::size_t k = 0; k < N::size(); ++k)
      to[k] = {static_cast<std::int32_t>(x[k]), static_cast<std::int32_t>(y[k]), near[k]};
}

template <class N>
Vec3<N> Projector::in_camera(const Vec3<N>& position) const {
  const Vec3<N> from_eye = position - Vec3<N>(frame_.eye);
  return {dot(from_eye, Vec3<N>(frame_.right)), dot(from_eye, Vec3<N>(frame_.up)),
          -dot(from_eye, Vec3<N>(frame_.back))};
}

// Returns the distance of a point, in pixels at depth 1, to the inside of a side of the guard region.
// Sides: left, right, top, bottom, and the plane of the eye.
template <class N>
N Projector::beyond_guard(const Vec3<N>& at, int side) const {
  if (side == 4) return at.z;
  const N half((side < 2 ? width_ : height_) / 2.0 + kGuard), depth = parallel_ ? N(1) : at.z;
  const N along = (side < 2 ? at.x : at.y) * scale_;
  return half * depth + (side % 2 == 0 ? along : N(-along));
}

template <class N>
void Projector::place(const Vec3<N>& at, N& x, N& y) const {
  using std::nearbyint;
  const N scale = parallel_ ? N(scale_) : N(scale_ / at.z);
  x = nearbyint(N((at.x * scale + width_ / 2.0) * kSubpixels));
  y = nearbyint(N((height_ / 2.0 - at.y * scale) * kSubpixels));
}

bool Projector::place(const std::array<const ClippedCorner*, 3>& corners, ScreenTriangle& triangle) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& at = corners[i]->at;
    if (!parallel_ && !(at.z > 0)) return false;
    double x, y;
    place(at, x, y);
    triangle.x[i] = static_cast<std::int32_t>(x);
    triangle.y[i] = static_cast<std::int32_t>(y);
    triangle.nearness[i] = nearness(at);
  }
  return true;
}

// Returns whether the corners are all beyond one side of the image, or behind the eye.
bool Projector::outside_image(const Polygon& triangle) const {
  const double right = width_ / 2.0 + reach_, top = height_ / 2.0 + reach_;
  bool left_of = true, right_of = true, above = true, below = true, behind = true;
  for (const ClippedCorner& corner : triangle) {
    const Vec3d& at = corner.at;
    const double x = at.x * scale_, y = at.y * scale_, depth = parallel_ ? 1 : at.z;
    left_of = left_of && x < -right * depth;
    right_of = right_of && x > right * depth;
    below = below && y < -top * depth;
    above = above && y > top * depth;
    behind = behind && at.z <= 0;
  }
  return left_of || right_of || above || below || behind;
}

Projector::Polygon Projector::clipped(const std::array<Vec3d, 3>& positions) const {
  Polygon polygon{{in_camera(positions[0]), {1, 0, 0}},
                  {in_camera(positions[1]), {0, 1, 0}},
                  {in_camera(positions[2]), {0, 0, 1}}};
  if (outside_image(polygon)) return {};
  for (int side = 0; side < 5; ++side) polygon = clipped(polygon, side);
  return polygon;
}

// Sutherland, Hodgman, "Reentrant polygon clipping" (1974). New corners are computed from the inner to the
// outer end of an edge, so that triangles that share the edge get equal corners.
Projector::Polygon Projector::clipped(const Polygon& polygon, int side) const {
  Polygon inside;
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

}  // namespace orrery
