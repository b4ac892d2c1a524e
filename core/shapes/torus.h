#pragma once

#include "core/math/bounds.h"
#include "core/math/depressed_cubic.h"
#include "core/math/hemisphere.h"
#include "core/model/shape.h"
#include "core/shapes/round_hull.h"

namespace orrery {

// Ring torus: a tube of radius `minor` around a circle of radius `major`. REQUIRES: minor < major.
template <class N>
struct Torus {
  Vec3<N> center, axis;  // the axis is a unit vector
  N major, minor;
  N magnitude;  // upper bound of the absolute coordinates

  static constexpr ShapeTraits kTraits = {.convex = false, .closed = true};

  static void read(Params& p, std::vector<Torus<double>>& out);
  void tessellate(const TessellationView& view, int primitive, Tessellation& out) const;

  Boundsd bounds() const { return Boundsd::around(center, round_reach(axis) * major + Vec3d(minor)); }

  std::vector<HullTriangle> hull() const {
    return round_hull(Vec3d(center), Vec3d(axis), double(major) + double(minor), double(minor));
  }

  // Returns the distance to the nearest hit ahead of the origin, or infinity for a miss.
  //
  // The implicit function of the torus along a ray is a quartic F(s), where s is the distance from the ray's
  // point nearest to the centre. There, F has no cubic term. F is monotonic between the roots of its
  // derivative, a cubic, so the sign of F at these roots shows which interval contains the first hit. The
  // signs, and the hit within the interval, are computed from the distance to the circle in the tube
  // (depth()). That distance does not cancel, unlike the coefficients of F. Each decision is exact for a ray
  // within a few ulp of the given one.
  N distance(const Ray<N>& ray) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const N zero(T(0)), infinity(std::numeric_limits<T>::infinity());
    const Tangents<N> axes = tangents_of(axis);
    const auto to_local = [&](const Vec3<N>& v) {
      return Vec3<N>(dot(v, axes.first), dot(v, axes.second), dot(v, axis));
    };
    const Vec3<N> origin = to_local(ray.origin - center), direction = to_local(ray.direction);
    const N speed = length(direction);
    const Vec3<N> unit = direction * (T(1) / speed);
    const N start = dot(origin, unit);
    const Line line{origin - unit * start, unit};

    const Span ring = span_of(line);
    const N begin = max_first(ring.low, start);
    const auto meets = begin <= ring.high;
    if (!any(meets)) return infinity;
    const auto inside = start >= ring.low && depth(origin) < zero;
    const CubicRoots<N> turns = turning_points(line);
    const auto below = [&](const N& s) { return s > begin && depth(line.at(s)) <= zero; };
    const auto first = below(turns.low), last = below(turns.high);
    const auto gap = turns.middle > begin && depth(line.at(turns.middle)) > zero;
    // A ray from outside enters before the minimum of F that is below 0. A ray from inside leaves after it.
    const auto early = select_mask(inside, gap, first);
    const N least = select(early, turns.low, turns.high);
    const N low_if_inside = max_first(begin, least);
    const N low = select(inside, low_if_inside, select(early, begin, max_first(begin, turns.middle)));
    const N high = select(inside, select(early, turns.middle, ring.high), least);
    const auto found = meets && (inside || first || last);
    if (!any(found)) return infinity;
    const N s = crossing(line, {low, high}, least, inside, found);
    const N t = (s - start) / speed;
    return select(found && t > zero, t, infinity);
  }

  Surface<N> surface(const Ray<N>& ray, const N& t) const {
    const Vec3<N> from = ray.at(t) - center;
    const Vec3<N> across = from - axis * dot(from, axis);
    const Vec3<N> on_circle = across * (major / length(across));
    const Vec3<N> normal = normalize(from - on_circle);
    return {center + (on_circle + normal * minor), normal, normal, magnitude};
  }

  // u is the angle around the axis in turns, anticlockwise as seen from the tip of `axis`. v is the angle
  // around the tube in turns, from 0 at the outer equator toward the tip. Both are in [0, 1].
  SurfacePoint<N> parameters(const Ray<N>&, const Vec3<N>& position) const {
    using std::sqrt;
    const Tangents<N> axes = tangents_of(axis);
    const Vec3<N> from = position - center;
    const N x = dot(from, axes.first), y = dot(from, axes.second), from_axis = sqrt(x * x + y * y);
    const N u = positive_turns(x, y), v = positive_turns(N(from_axis - major), dot(from, axis));
    return {u, v, u, v, axes.second * (x / from_axis) - axes.first * (y / from_axis)};
  }

 private:
  // Ray in coordinates whose z axis is the axis of the torus.
  struct Line {
    Vec3<N> nearest;  // to the centre
    Vec3<N> unit;
    Vec3<N> at(const N& s) const { return nearest + unit * s; }
  };
  struct Span {
    N low, high;
  };

  static MaskOf<N> select_mask(const MaskOf<N>& mask, const MaskOf<N>& a, const MaskOf<N>& b) {
    return (mask && a) || (!mask && b);
  }

  // Returns the squared distance from the circle in the tube, minus minor^2: negative inside the torus.
  N depth(const Vec3<N>& p) const {
    using std::sqrt;
    const N across = sqrt(p.x * p.x + p.y * p.y) - major;
    return across * across + p.z * p.z - minor * minor;
  }

  // Returns the part of the line in the bounding sphere and in the slab |z| <= minor, padded for rounding. It
  // is empty (low > high or NaN) for most lines that miss.
  Span span_of(const Line& line) const {
    using T = ScalarOf<N>;
    using std::signbit;
    using std::sqrt;
    const N reach = major + minor, padding = reach * (16 * std::numeric_limits<T>::epsilon());
    const N padded = reach + padding, from_center = length(line.nearest);
    const N half = sqrt((padded - from_center) * (padded + from_center));  // NaN outside the sphere
    const auto inverted = signbit(line.unit.z);
    const N top = select(inverted, N(-minor - padding), N(minor + padding));
    const N near = (-top - line.nearest.z) / line.unit.z, far = (top - line.nearest.z) / line.unit.z;
    return {max_first(N(-half), near), min_first(half, far)};
  }

  // Returns the roots of F', in metres. In units of `major`,
  //   F = (s^2 + h^2 + 1 - k^2)^2 - 4 (s^2 + h^2 - (h_z + s u_z)^2)
  // with h the nearest point, u the unit direction and k the minor radius.
  CubicRoots<N> turning_points(const Line& line) const {
    using T = ScalarOf<N>;
    const Vec3<N> h = line.nearest * (T(1) / major);
    const N k = minor / major, slant = line.unit.z;
    const CubicRoots<N> roots =
        depressed_cubic_roots<N>(dot(h, h) - T(1) - k * k + T(2) * slant * slant, T(2) * h.z * slant);
    return {roots.low * major, roots.middle * major, roots.high * major};
  }

  // Distance from the axis along a line, and its derivative.
  struct AxisDistance {
    N value, rate;
  };
  static AxisDistance axis_distance(const Line& line, const Vec3<N>& p) {
    using std::sqrt;
    const N value = sqrt(p.x * p.x + p.y * p.y);
    return {value, (p.x * line.unit.x + p.y * line.unit.y) / value};
  }

  // Returns an estimate of the crossing before or after the minimum `least` of F: a zero of the parabola that
  // touches depth() there. NaN if there is none.
  N parabola_crossing(const Line& line, const N& least, const N& sign) const {
    using T = ScalarOf<N>;
    using std::sqrt;
    const Vec3<N> p = line.at(least), u = line.unit;
    const AxisDistance from_axis = axis_distance(line, p);
    const N bend = (u.x * u.x + u.y * u.y - from_axis.rate * from_axis.rate) / from_axis.value;
    return least + sign * sqrt(depth(p) / (major * bend - T(1)));
  }

  // Returns the only crossing of the surface in `bracket`, where F is monotonic: rising if `leaving`, else
  // falling. `least` is a minimum of F next to the crossing. Newton's iteration falls back to bisection.
  // Inactive lanes are unspecified.
  N crossing(const Line& line, Span bracket, const N& least, const MaskOf<N>& leaving,
             MaskOf<N> active) const {
    using T = ScalarOf<N>;
    using std::abs;
    constexpr int kMaxSteps = 64;
    const N tolerance = (major + minor) * (2 * std::numeric_limits<T>::epsilon());
    const N sign = select(leaving, N(T(1)), N(T(-1)));
    const auto or_middle = [&](const N& s) {
      return select(s >= bracket.low && s <= bracket.high, s, N((bracket.low + bracket.high) * T(0.5)));
    };
    N s = or_middle(parabola_crossing(line, least, sign));
    for (int step = 0; step < kMaxSteps && any(active); ++step) {
      const Vec3<N> p = line.at(s);
      const AxisDistance from_axis = axis_distance(line, p);
      const N across = from_axis.value - major;
      const N value = sign * (across * across + p.z * p.z - minor * minor);
      const N rate = sign * T(2) * (across * from_axis.rate + p.z * line.unit.z);
      const auto before = value < N(T(0));
      bracket.low = select(active && before, s, bracket.low);
      bracket.high = select(active && !before, s, bracket.high);
      const N next = or_middle(N(s - value / rate));
      const auto settled = abs(next - s) <= tolerance;
      s = select(active, next, s);
      active = active && !settled;
    }
    return s;
  }
};

}  // namespace orrery
