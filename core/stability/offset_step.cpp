#include <bit>
#include <cmath>

#include "core/stability/one_shape.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Returns coordinate p of a point, moved off a surface by 256 * normal units in the last place (Waechter,
// Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, 2019).
float moved_by_places(float p, float normal) {
  constexpr float kOrigin = 1.0f / 32, kFloatScale = 1.0f / 65536, kIntegerScale = 256;
  if (std::abs(p) < kOrigin) return p + kFloatScale * normal;
  const auto places = static_cast<std::int32_t>(kIntegerScale * normal);
  return std::bit_cast<float>(std::bit_cast<std::int32_t>(p) + (p < 0 ? -places : places));
}

// Measures the offset along x of a ray that leaves a ball of radius 1 m at (1e6, 1e6, 1e6) m.
StabilityFigures measure() {
  const Vec3f at(1e6f + 1, 1e6f, 1e6f);
  const double known = static_cast<double>(moved_by_places(at.x, 1) - at.x);
  OneShape<double> ball(R"({"type": "sphere", "center": [1e6, 1e6, 1e6], "radius": 1, "material": "m"})");
  const Ray<double> ray{{1e6 + 5, 1e6, 1e6}, {-1, 0, 0}};
  ball.meet(std::span(&ray, 1));
  return {known, ball.surface().step[0]};
}

}  // namespace

StabilityRow offset_step_row() {
  return {
      "A17",
      "Ray offset 1,000 km from the origin",
      "rays that leave a ball of radius 1 m at coordinates of 1e6 m: distance of their origins from the ball",
      "m",
      "256 units in the last place of each coordinate, in float (Waechter, Binder 2019)",
      10,
      "8 machine epsilons times the largest coordinate, in double, which the plan chooses there",
      2e-9,
      measure};
}

}  // namespace orrery
