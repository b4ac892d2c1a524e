#include "core/materials/ggx_albedo.h"

#include <cmath>

#include "core/materials/microfacet.h"

namespace orrery {
namespace {

constexpr std::size_t kTerms = 14;
constexpr std::size_t kRows = 32;  // values of alpha, evenly spaced in [0, 1]
using Row = std::array<double, kTerms>;

// Returns the mean of G2 / G1 over the normals visible from a viewer at cosine mu, by the midpoint rule. Uses
// half of the azimuths, because the other half is symmetric.
double albedo(double alpha, double mu) {
  constexpr int kDepths = 256, kAzimuths = 32;
  const Ggx<double> facets{alpha};
  const Vec3d viewer(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (int j = 0; j < kAzimuths; ++j)
    for (int i = 0; i < kDepths; ++i) {
      const Vec3d normal = facets.visible_normal(viewer, (i + 0.5) / kDepths, (j + 0.5) / (2 * kAzimuths));
      const double light = mirrored_about(viewer, normal).z;
      if (light > 0)
        sum += light * (mu + facets.stretched(mu)) /
               (light * facets.stretched(mu) + mu * facets.stretched(light));
    }
  return sum / (kDepths * kAzimuths);
}

// Returns one row per alpha: the albedos at the nodes of the series.
std::array<Row, kRows> make_table() {
  constexpr double kMinAlpha = 1e-4;  // as alpha goes to 0, E depends only on mu / alpha
  std::array<Row, kRows> table;
  for (std::size_t row = 0; row < kRows; ++row) {
    const double alpha = std::max(kMinAlpha, static_cast<double>(row) / (kRows - 1));
    for (std::size_t k = 0; k < kTerms; ++k) table[row][k] = albedo(alpha, series_node<kTerms>(alpha, k));
  }
  return table;
}

}  // namespace

GgxAlbedo<double> ggx_albedo(double alpha) {
  static const std::array<Row, kRows> table = make_table();
  const double place = alpha * (kRows - 1);
  const std::size_t row = std::min(static_cast<std::size_t>(place), kRows - 2);
  const double share = place - static_cast<double>(row);
  Row values;
  for (std::size_t k = 0; k < kTerms; ++k)
    values[k] = (1 - share) * table[row][k] + share * table[row + 1][k];
  return series_through(values, alpha);
}

}  // namespace orrery
