#include <cmath>

#include "core/shapes/sphere.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"

namespace orrery {
namespace {

constexpr int kRays = 20'000;

// Returns whether the discriminant b^2 - 4 a c is at least 0 (Glassner, "An Introduction to Ray Tracing",
// 1989, chapter 2). The sphere has radius 1 and centre 0.
bool textbook_meets(const Ray<float>& ray) {
  const float a = dot(ray.direction, ray.direction), b = 2 * dot(ray.origin, ray.direction);
  const float c = dot(ray.origin, ray.origin) - 1;
  return b * b - 4 * a * c >= 0;
}

// Returns the exact result, computed in double: whether the line of the ray is at most 1 from the centre.
bool meets(const Ray<float>& ray) {
  const Vec3d o(ray.origin), d(ray.direction);
  const Vec3d closest = o - d * (dot(o, d) / dot(d, d));
  return dot(closest, closest) <= 1;
}

// Returns the percentage of rays with a wrong hit or miss. The rays start `distance` radii away and pass the
// centre at up to 1.2 radii.
StabilityFigures wrong_from(double distance) {
  const Ball<float> ball{Vec3f(), 1};
  SplitMix random(1);
  int known = 0, ours = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3d direction = direction_from(random), other = direction_from(random);
    const Vec3d across = safe_normalize(cross(direction, other));
    const Ray<float> ray{Vec3f(across * random.between(0, 1.2) - direction * distance), Vec3f(direction)};
    const bool met = meets(ray);
    known += textbook_meets(ray) != met;
    ours += std::isfinite(ball.distance(ray)) != met;
  }
  return {100.0 * known / kRays, 100.0 * ours / kRays};
}

StabilityFigures measure() {
  LineChart chart{"far-sphere",
                  "Wrong hits and misses of a sphere, in float",
                  "distance from the sphere, radii",
                  "wrong hits and misses, %",
                  true,
                  true,
                  {{"textbook", {}}, {"perpendicular residue", {}}}};
  for (const double distance : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    const StabilityFigures wrong = wrong_from(distance);
    chart.series[0].points.push_back({distance, wrong.known});
    chart.series[1].points.push_back({distance, wrong.ours});
  }
  StabilityFigures figures = wrong_from(1e4);
  figures.chart = std::move(chart);
  return figures;
}

}  // namespace

StabilityRow far_sphere_row() {
  return {"A1",
          "Distant sphere",
          "rays toward a sphere 10,000 radii away, in float: wrong hits and misses",
          "%",
          "discriminant b^2 - 4 a c (Glassner 1989)",
          20,
          "discriminant from the component of the origin perpendicular to the ray (Haines and others 2019)",
          0.02,
          measure};
}

}  // namespace orrery
