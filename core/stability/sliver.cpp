#include <algorithm>
#include <cmath>

#include "core/shapes/triangle_hit.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"

namespace orrery {
namespace {

// Returns the weights of the vertices. Products of the edge functions are rounded before subtraction, as
// published (Woop, Benthin, Wald 2013).
Vec3f rounded_weights(const Ray<float>& ray, const Corners<float>& corners) {
  const OwnAxes<float> axes(ray);
  const Sheared<float> a = axes(corners.a), b = axes(corners.b), c = axes(corners.c);
  const float u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
  return Vec3f(u, v, w) / (u + v + w);
}

// Returns the distance in metres between `found` and the exact intersection with the plane y = 0.
double slip(const Ray<float>& ray, const Vec3f& found) {
  const double t = -static_cast<double>(ray.origin.y) / static_cast<double>(ray.direction.y);
  return length(Vec3d(found) - (Vec3d(ray.origin) + Vec3d(ray.direction) * t));
}

// Measures rays that start 10 cm from a triangle, one half of a strip 100 m long and 1 mm wide.
StabilityFigures measure() {
  const float w = 0.0005f, l = 50;
  const Corners<float> half{{-w, 0, -l}, {-w, 0, l}, {w, 0, -l}};
  SplitMix random(6);
  StabilityFigures worst{0, 0};
  for (int i = 0; i < 2000; ++i) {
    const Vec3d at(random.between(-0.0005, 0), 0, random.between(-5, 0));
    const Vec3d from = at + direction_above(random, {0, 1, 0}) * 0.1;
    const Ray<float> ray{Vec3f(from), Vec3f(safe_normalize(at - from))};
    if (!std::isfinite(half.distance(ray)) || std::abs(ray.direction.y) < 0.1f) continue;
    worst.known = std::max(worst.known, slip(ray, half.mix(rounded_weights(ray, half))));
    worst.ours = std::max(worst.ours, slip(ray, half.mix(half.weights(ray))));
  }
  return worst;
}

}  // namespace

StabilityRow sliver_row() {
  return {
      "A15",
      "Sliver of aspect ratio 100,000",
      "hit points on a triangle 100 m long and 1 mm wide, in float: largest distance from the exact points",
      "m",
      "barycentric weights from rounded products (Woop, Benthin, Wald 2013, as printed)",
      1e-3,
      "products that are exact until the subtraction (Dekker 1971)",
      1e-5,
      measure};
}

}  // namespace orrery
