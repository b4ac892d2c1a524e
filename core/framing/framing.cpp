#include "core/framing/framing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/angles.h"
#include "core/math/bounds.h"

namespace orrery {
namespace {

// Largest and smallest value.
struct Interval {
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;

  void add(double middle, double reach = 0) {
    lo = std::min(lo, middle - reach);
    hi = std::max(hi, middle + reach);
  }
  // Extends the interval to be symmetric about 0.
  void centre() {
    hi = std::max(hi, -lo);
    lo = -hi;
  }
  double middle() const { return lo + size() / 2; }
  double size() const { return hi - lo; }
};

// Least distance from the camera to the nearest point, relative to the size of the points.
constexpr double kLeastGap = 0.1;

// Camera axes in scene coordinates, and their sines.
struct ViewAxes {
  Vec3d right, up, back;
  SineCosine elevation;
};

ViewAxes axes_of(const StudioAxes& axes, const ViewDirection& from) {
  const SineCosine turn = sine_cosine_degrees(from.azimuth), rise = sine_cosine_degrees(from.elevation);
  const Vec3d level = axes.front * turn.cosine + axes.right * turn.sine;
  return {axes.right * turn.cosine - axes.front * turn.sine, axes.up * rise.cosine - level * rise.sine,
          level * rise.cosine + axes.up * rise.sine, rise};
}

// Coordinates of the points along one axis of the image. A camera at p = e and at the distance d sees a point
// at p and at the depth q, measured toward the camera, if |p - e| <= slope (d - q). This holds for all points
// if e is the middle of `cone` and d is at least its size / (2 slope).
struct Extent {
  double slope;
  Interval cone;    // from the smallest p - slope q to the largest p + slope q
  Interval across;  // p
  Interval depth;   // q

  void add(double p, double q) { add(p, 0, q, 0, 0, 0); }
  // Adds points whose p, p + slope q, p - slope q and q are in intervals with these middles and half sizes.
  void add(double p, double p_reach, double q, double q_reach, double plus_reach, double minus_reach) {
    cone.hi = std::max(cone.hi, p + slope * q + plus_reach);
    cone.lo = std::min(cone.lo, p - slope * q - minus_reach);
    across.add(p, p_reach);
    depth.add(q, q_reach);
  }
  double distance() const { return cone.size() / (2 * slope); }
};

struct Extents {
  Extent x, y;

  // Adds a circle of radius r about the vertical axis at the height h.
  void add_circle(double r, double h, const SineCosine& rise) {
    const double p = h * rise.cosine, q = h * rise.sine, q_reach = r * std::abs(rise.cosine);
    const double sideways = r * std::sqrt(1 + x.slope * x.slope * rise.cosine * rise.cosine);
    x.add(0, r, q, q_reach, sideways, sideways);
    y.add(p, r * std::abs(rise.sine), q, q_reach, r * std::abs(y.slope * rise.cosine - rise.sine),
          r * std::abs(y.slope * rise.cosine + rise.sine));
  }
  void centre() {
    for (Extent* e : {&x, &y}) {
      e->cone.centre();
      e->across.centre();
    }
  }
};

// Returns a distance of at least `least` that is in front of all points. Otherwise the camera would touch a
// point behind which all others are hidden, such as the end of a needle.
double distance_from(const Extents& e, double least) {
  const double size = std::max({e.x.across.size(), e.y.across.size(), e.x.depth.size()});
  return std::max(least, e.x.depth.hi + (size > 0 ? size * kLeastGap : 1.0));
}

}  // namespace

StudioAxes StudioAxes::with_up(const Vec3d& up) {
  if (up.y != 0) return {{1, 0, 0}, up, {0, 0, up.y}};
  if (up.z != 0) return {{1, 0, 0}, up, {0, -up.z, 0}};
  return {{0, -up.x, 0}, up, {0, 0, 1}};
}

Framing frame_points(std::span<const Vec3d> points, const FramingRequest& request) {
  Boundsd bounds;
  for (const Vec3d& point : points) bounds.include(point);
  const Vec3d centre = bounds.lo + (bounds.hi - bounds.lo) * 0.5;
  const ViewAxes view = axes_of(request.axes, request.from);
  const double used = 1 - 2 * request.margin;
  const bool parallel = request.fov_degrees == 0;
  const double slope = parallel ? 0 : used * tangent_degrees(request.fov_degrees / 2);

  Extents e{{slope * request.aspect, {}, {}, {}}, {slope, {}, {}, {}}};
  for (const Vec3d& point : points) {
    const Vec3d p = point - centre;
    const double toward_right = dot(p, request.axes.right), toward_front = dot(p, request.axes.front);
    if (request.fit == Fit::turn) {
      e.add_circle(std::sqrt(toward_right * toward_right + toward_front * toward_front),
                   dot(p, request.axes.up), view.elevation);
    } else {
      e.x.add(dot(p, view.right), dot(p, view.back));
      e.y.add(dot(p, view.up), dot(p, view.back));
    }
  }
  if (request.fit == Fit::turn) e.centre();

  Framing framing;
  framing.up = std::abs(view.elevation.cosine) > 1e-9 ? request.axes.up : view.up;
  if (parallel) {
    framing.height = std::max(e.y.across.size(), e.x.across.size() / request.aspect) / used;
    if (!(framing.height > 0)) framing.height = 1;
  }
  const double distance =
      distance_from(e, parallel ? framing.height : std::max(e.x.distance(), e.y.distance()));
  framing.look_at = centre + view.right * (parallel ? e.x.across : e.x.cone).middle() +
                    view.up * (parallel ? e.y.across : e.y.cone).middle();
  framing.eye = framing.look_at + view.back * distance;
  return framing;
}

}  // namespace orrery
