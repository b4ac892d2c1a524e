#pragma once

#include <algorithm>

#include "core/math/bounds.h"
#include "core/params/params.h"
#include "core/shapes/bezier_piece.h"

// Keys that curved patches share. The functions record problems in Params.
namespace orrery {

// Control points with weights, relative to `origin`.
struct ControlPoints {
  std::vector<Vec3d> points;
  std::vector<double> weights;
  bool rational;  // some weights differ
  Vec3d origin;   // centre of the box of the points

  // Stores the products of control point `from` with its weight, and the weight, as entry `to` of four nets
  // of `size` entries each.
  void put(std::size_t from, std::vector<double>& nets, std::size_t to, std::size_t size) const {
    const double w = weights[from];
    for (std::size_t axis = 0; axis < 3; ++axis) nets[axis * size + to] = points[from][axis] * w;
    nets[3 * size + to] = w;
  }
};

inline NetDegrees read_degrees(Params& p, Fallback<std::int64_t> fallback = {}) {
  const auto u = p.integer("degree_u", "Degree along u.", 1, kMaxBezierDegree, fallback);
  const auto v = p.integer("degree_v", "Degree along v.", 1, kMaxBezierDegree, fallback);
  return {static_cast<int>(u), static_cast<int>(v)};
}

inline ControlPoints read_control_points(Params& p, std::string_view doc) {
  constexpr Count kPoints{4, 65'536};
  ControlPoints control{p.points("points", doc, kPoints), {}, false, {}};
  control.weights = p.numbers("weights", "Weight of each point; default: all 1.", {0, kPoints.max},
                              {.min = 1e-6, .max = 1e6});
  const std::size_t count = control.points.size();
  if (!control.weights.empty() && control.weights.size() != count)
    p.fail("weights", "must be a list of " + std::to_string(count) + " entries, one per point (got " +
                          std::to_string(control.weights.size()) + ")");
  if (control.weights.size() != count) control.weights.assign(count, 1.0);
  const auto [low, high] = std::minmax_element(control.weights.begin(), control.weights.end());
  control.rational = *low < *high;
  if (!control.rational) control.weights.assign(count, 1.0);
  Boundsd box;
  for (const Vec3d& point : control.points) box.include(point);
  if (box.lo == box.hi) p.fail("points", "must not all be the same point");
  control.origin = (box.lo + box.hi) * 0.5;
  for (Vec3d& point : control.points) point = point - control.origin;
  return control;
}

}  // namespace orrery
