#include <algorithm>
#include <cmath>

#include "core/shapes/torus.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"

namespace orrery {
namespace {

constexpr double kMajor = 1, kMinor = 0.25;  // torus around the z axis, centre 0
constexpr double kDistance = 1'000;          // distance of the ray origins from the centre
constexpr int kRays = 1'000;

// Returns the root next to `exact` of the quartic in the distance, by Newton's iteration. The coefficients
// are those at the origin of the ray (Hanrahan, "A Survey of Ray-Surface Intersection Algorithms", in
// Glassner, "An Introduction to Ray Tracing", 1989).
double textbook_distance(const Ray<double>& ray, double exact) {
  const Vec3d o = ray.origin, d = ray.direction;
  const double along = dot(o, d), k = dot(o, o) - kMajor * kMajor - kMinor * kMinor;
  const double c3 = 4 * along, c2 = 2 * k + 4 * along * along + 4 * kMajor * kMajor * d.z * d.z;
  const double c1 = 4 * k * along + 8 * kMajor * kMajor * o.z * d.z;
  const double c0 = k * k - 4 * kMajor * kMajor * (kMinor * kMinor - o.z * o.z);
  double t = exact;
  for (int step = 0; step < 30; ++step)
    t -= ((((t + c3) * t + c2) * t + c1) * t + c0) / (((4 * t + 3 * c3) * t + 2 * c2) * t + c1);
  return t;
}

// Rays in the plane of the equator meet it as a circle of radius `kMajor` + `kMinor`.
StabilityFigures measure() {
  const Torus<double> torus{Vec3d(), Vec3d(0, 0, 1), kMajor, kMinor, kMajor + kMinor};
  SplitMix random(1);
  StabilityFigures worst{0, 0};
  for (int i = 0; i < kRays; ++i) {
    const double x = random.between(-1, 1), y = std::sqrt(1 - x * x), offset = random.between(0, kMajor);
    const Vec3d direction(x, y, 0), across(-y, x, 0);
    const Ray<double> ray{across * offset - direction * kDistance, direction};
    const double exact = kDistance - std::sqrt((kMajor + kMinor) * (kMajor + kMinor) - offset * offset);
    worst.known = std::max(worst.known, std::abs(textbook_distance(ray, exact) - exact));
    worst.ours = std::max(worst.ours, std::abs(torus.distance(ray) - exact));
  }
  return worst;
}

}  // namespace

StabilityRow torus_quartic_row() {
  return {
      "A39",
      "Distant torus",
      "distance to a torus of radii 1 m and 0.25 m from 1,000 m away, in double: largest error",
      "m",
      "quartic with coefficients at the origin of the ray (Hanrahan 1989)",
      1e-6,
      "quartic at the ray's point nearest to the centre brackets the hit; Newton's iteration on the distance "
      "from the circle in the tube",
      1e-12,
      measure};
}

}  // namespace orrery
