#include <cmath>

#include "core/shapes/triangle_hit.h"
#include "core/stability/moller_trumbore.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Counts the right triangles that a ray from 1 m above misses. The legs are 0.99 m to 0.99 pm long. The
// determinant of a triangle is the square of its leg.
StabilityFigures measure() {
  StabilityFigures missed{0, 0};
  double side = 0.99;
  for (int i = 0; i < 13; ++i, side /= 10) {
    const Vec3d a, b(side, 0, 0), c(0, side, 0);
    const Ray<double> ray{{side / 4, side / 4, 1}, {0, 0, -1}};
    missed.known += !std::isfinite(moller_trumbore(ray, a, b, c, 1e-6));
    missed.ours += !std::isfinite(Corners<double>{a, b, c}.distance(ray));
  }
  return missed;
}

}  // namespace

StabilityRow small_triangle_row() {
  return {"A13",
          "Small triangles",
          "13 triangles with sides from 0.99 m to 0.99 pm, one ray at each: triangles missed",
          "of 13",
          "determinants below 1e-6 treated as 0 (Moeller, Trumbore 1997, as printed)",
          10,
          "only a determinant of exactly 0 counts as a miss",
          0,
          measure};
}

}  // namespace orrery
