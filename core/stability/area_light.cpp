#include <cmath>

#include "core/lights/emitters.h"
#include "core/stability/row.h"

namespace orrery {
namespace {

// Returns the standard deviation of estimate(u, v) over its mean, on a regular grid of n x n points.
template <class Estimate>
double relative_deviation(int n, const Estimate& estimate) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double value = estimate((i + 0.5) / n, (j + 0.5) / n);
      sum += value;
      squares += value * value;
    }
  const double mean = sum / n / n;
  return std::sqrt(std::max(0.0, squares / n / n - mean * mean)) / mean;
}

// Returns the relative deviation of both estimators for a square light of side 1 m. The light is parallel to
// the surface, and its centre is `height` metres above the point.
StabilityFigures deviations(double height) {
  const auto light = make_emitter(
      {Patch::Kind::rectangle, Vec3d(-0.5, height, -0.5), Vec3d(1, 0, 0), Vec3d(0, 0, 1)}, Vec3d(1));
  const double by_area = relative_deviation(1000, [&](double u, double v) {
    const double x = u - 0.5, z = v - 0.5, d2 = x * x + z * z + height * height;
    return height * height / (d2 * d2);  // both cosines over the squared distance
  });
  const double ours = relative_deviation(200, [&](double u, double v) {
    const auto drawn = light.draw(Vec3d(), u, v);
    return drawn.pdf > 0 ? normalize(drawn.point).y / drawn.pdf : 0;
  });
  return {by_area, ours};
}

StabilityFigures measure() {
  LineChart chart{"area-light",
                  "Noise of one sample of a square light of side 1 m",
                  "distance from the centre of the light, m",
                  "standard deviation / mean",
                  true,
                  true,
                  {{"by area", {}}, {"by solid angle", {}}}};
  for (const double height : {0.01, 0.03, 0.1, 0.3, 1.0}) {
    const StabilityFigures at = deviations(height);
    chart.series[0].points.push_back({height, at.known});
    chart.series[1].points.push_back({height, at.ours});
  }
  return {chart.series[0].points[0].second, chart.series[1].points[0].second, std::move(chart)};
}

}  // namespace

StabilityRow area_light_row() {
  return {
      "B16",
      "Square light at a distance of 1 cm",
      "irradiance 1 cm in front of the centre of a square light of side 1 m: standard deviation of a sample, "
      "relative to the mean",
      "1",
      "points sampled uniformly by area (Cook, Porter, Carpenter 1984)",
      25,
      "points sampled uniformly by solid angle (Urena, Fajardo, King 2013)",
      1,
      measure};
}

}  // namespace orrery
