#include <algorithm>
#include <cmath>

#include "core/shapes/cylinder.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Returns the smaller root for a cylinder of radius 1 around the z axis as (-B - sqrt(D)) / 2 * A, evaluated
// from left to right.
double misread_distance(const Ray<double>& ray) {
  const Vec3d o = ray.origin, d = ray.direction;
  const double a = d.x * d.x + d.y * d.y, b = 2 * (o.x * d.x + o.y * d.y), c = o.x * o.x + o.y * o.y - 1;
  return (-b - std::sqrt(b * b - 4 * a * c)) / 2 * a;
}

// Rays from x = -5 hit the cylinder at x = -1.
StabilityFigures measure() {
  const Cylinder<double> cylinder{Vec3d(), Vec3d(0, 0, 1), 1, std::numeric_limits<double>::infinity(), 1};
  StabilityFigures worst{0, 0};
  for (const Vec3d& direction : {Vec3d(0.6, 0, 0.8), Vec3d(2, 0, 0), Vec3d(0.1, 0, std::sqrt(0.99))}) {
    const Ray<double> ray{{-5, 0, 0}, direction};
    const double exact = 4 / direction.x;
    worst.known = std::max(worst.known, std::abs(misread_distance(ray) / exact - 1));
    worst.ours = std::max(worst.ours, std::abs(cylinder.distance(ray) / exact - 1));
  }
  return worst;
}

}  // namespace

StabilityRow cylinder_roots_row() {
  return {"A7",
          "Roots of a cylinder",
          "distance to a cylinder along slanted rays and rays with directions of length 2: largest relative "
          "error",
          "1",
          "(-B - sqrt(D)) / 2 * A as printed, without parentheses around 2 A",
          10,
          "roots c / q and q / a; discriminant from the perpendicular residue",
          1e-15,
          measure};
}

}  // namespace orrery
