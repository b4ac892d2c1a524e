#include <vector>

#include "core/stability/one_shape.h"
#include "core/stability/row.h"
#include "core/stability/split_mix.h"
#include "core/study/svg.h"

namespace orrery {
namespace {

const Vec3d kNormal = safe_normalize(Vec3d(1, 2, 3));

// Returns whether a ray that starts at the computed hit o + t d meets the plane again beyond a fixed epsilon
// of 1e-4. Introductory texts use such an epsilon, e.g. 1e-3 in Shirley, "Ray Tracing in One Weekend".
bool meets_again(const Ray<float>& ray, const Vec3f& at, const Vec3f& normal, const Vec3f& direction) {
  const float t = dot(at - ray.origin, normal) / dot(ray.direction, normal);
  const Vec3f hit = ray.at(t);
  return dot(at - hit, normal) / dot(direction, normal) > 1e-4f;
}

// Returns the percentage of rays that leave a plane through (c, c, c) and hit the plane again.
StabilityFigures self_hits_at(double c) {
  constexpr int kBatches = 20;
  OneShape<float> plane(printed(R"({"type": "plane", "point": [%.17g, %.17g, %.17g], "normal": [1, 2, 3],
                                  "material": "m"})",
                                c, c, c));
  const Vec3f at(Vec3d(c, c, c)), normal(kNormal);
  SplitMix random(1);
  int known = 0, ours = 0;
  for (int batch = 0; batch < kBatches; ++batch) {
    std::vector<Ray<float>> rays;
    std::vector<Vec3f> leaving;
    while (rays.size() < kBatch) {
      const Vec3d toward = -direction_above(random, kNormal);
      if (dot(toward, kNormal) > -0.1) continue;
      const Vec3d offset = random.in_cube(1), on = Vec3d(c, c, c) + offset - kNormal * dot(offset, kNormal);
      rays.push_back({Vec3f(on - toward * 10.0), Vec3f(toward)});
      leaving.push_back(Vec3f(direction_above(random, kNormal)));
      known += meets_again(rays.back(), at, normal, leaving.back());
    }
    plane.meet(rays);
    ours += plane.met_again(leaving);
  }
  return {100.0 * known / (kBatches * kBatch), 100.0 * ours / (kBatches * kBatch)};
}

StabilityFigures measure() {
  LineChart chart{"self-hit",
                  "Rays that leave a plane and hit it again, in float",
                  "coordinates of the plane, m",
                  "rays, %",
                  true,
                  true,
                  {{"fixed epsilon 1e-4", {}}, {"offset of 8 epsilons", {}}}};
  for (const double c : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
    const StabilityFigures hits = self_hits_at(c);
    chart.series[0].points.push_back({c, hits.known});
    chart.series[1].points.push_back({c, hits.ours});
  }
  StabilityFigures figures = self_hits_at(1e5);
  figures.chart = std::move(chart);
  return figures;
}

}  // namespace

StabilityRow self_hit_row() {
  return {"A16",
          "Shadow acne",
          "rays that leave a plane through (1e5, 1e5, 1e5), in float: rays that hit the plane again",
          "%",
          "hit at o + t d; hits nearer than a fixed epsilon of 1e-4 are ignored",
          30,
          "hit projected onto the shape, then offset along the normal by 8 machine epsilons times the "
          "largest coordinate",
          0,
          measure};
}

}  // namespace orrery
