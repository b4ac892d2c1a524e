#include "core/materials/sheen.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/task_scope.h"

namespace orrery {
namespace {

// Returns the albedo at the cosine `mu`: the integral of the BRDF times the cosine of the light, by the
// midpoint rule in the cube root of the cosine of the light and in half of the azimuths, because the other
// half is symmetric.
double albedo(const Sheen<double>& fibres, double mu) {
  constexpr int kCosines = 64, kAzimuths = 48;
  const Vec3d viewer(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (int i = 0; i < kCosines; ++i) {
    const double root = (i + 0.5) / kCosines, light = root * root * root, sine = std::sqrt(1 - light * light);
    double density = 0;
    for (int j = 0; j < kAzimuths; ++j) {
      const auto turn = sine_cosine_turns((j + 0.5) / (2 * kAzimuths));
      density += fibres.density(viewer + Vec3d(sine * turn.cosine, sine * turn.sine, light));
    }
    sum += density * fibres.visible(mu, light) * light * 3 * root * root;
  }
  return sum * 2 * std::numbers::pi / (kCosines * kAzimuths);
}

}  // namespace

SheenLayer<double> make_sheen_layer(double alpha) {
  constexpr std::size_t kTerms = std::tuple_size_v<decltype(SheenAlbedo<double>::coefficients)>;
  constexpr double kScale = 0.25;  // scale of the series
  Sheen<double> fibres{alpha, 1};
  std::array<double, kTerms> values;
  for (std::size_t k = 0; k < kTerms; ++k) {
    checkpoint();
    values[k] = albedo(fibres, series_node<kTerms>(kScale, k));
  }
  fibres.scale = 1 / std::max(1.0, *std::max_element(values.begin(), values.end()));
  for (double& value : values) value *= fibres.scale;
  return {fibres, series_through(values, kScale)};
}

}  // namespace orrery
