#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

Probe<double> clay(double reflectance, double roughness) {
  return Probe<double>(Json{{"type", "oren-nayar"}, {"reflectance", reflectance}, {"roughness", roughness}});
}

// Returns the directional albedo. Integrates by the midpoint rule over half the azimuths and over r in [0,
// 1], where the cosine is 1 - r^2.
double albedo(const Probe<double>& material, double cosine) {
  constexpr int kSteps = 256;
  std::vector<Case> cases;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double r = (i + 0.5) / kSteps;
      Case c;
      c.direction = -tilted(cosine);
      c.light = tilted(1 - r * r, (j + 0.5) / (2 * kSteps));
      cases.push_back(c);
    }
  double sum = 0;
  const auto found = material.evaluated(cases);
  for (std::size_t i = 0; i < cases.size(); ++i)
    sum += found[i].pi_bsdf_cos.x * 4 * std::sqrt(1 - cases[i].light.z);
  return sum / (kSteps * kSteps);
}

TEST(LambertMaterial, WeightsEverySampleByReflectance) {
  const Probe<double> material("{'type': 'lambert', 'reflectance': [0.7, 0.3, 0]}");
  for (const auto& drawn : material.sampled(Case{}, 10'000)) ASSERT_EQ(drawn.weight, Vec3d(0.7, 0.3, 0));
  EXPECT_EQ(material.ambient(), Vec3d(0.7, 0.3, 0));
  EXPECT_NEAR(albedo(material, 0.3), 0.7, 1e-5);
}

TEST(OrenNayarMaterial, EqualsLambertAtZeroRoughness) {
  const Probe<double> smooth = clay(0.7, 0), lambert("{'type': 'lambert', 'reflectance': 0.7}");
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    Case c;
    c.light = random.direction_above(c.normal);
    c.direction = -random.direction_above(c.normal);
    EXPECT_NEAR(smooth.evaluated(c).pi_bsdf_cos.x, lambert.evaluated(c).pi_bsdf_cos.x, 1e-15);
  }
}

TEST(OrenNayarMaterial, ReflectsAllLightIfWhite) {
  for (const double roughness : {0.1, 0.5, 1.0})
    for (const double cosine : {1.0, 0.7, 0.3, 0.1})
      EXPECT_NEAR(albedo(clay(1, roughness), cosine), 1, 2e-4) << roughness << " " << cosine;
}

// Single scattering of reflectance rho has the albedo rho E, E = A (1 + roughness G / pi). Multiple
// scattering adds rho_ms (1 - E). G is written as in the paper.
TEST(OrenNayarMaterial, MatchesAnalyticAlbedo) {
  constexpr double kPi = std::numbers::pi;
  const double a = 1 / (1 + (0.5 - 2 / (3 * kPi)) * 0.8);
  const double mean = a * (1 + (2.0 / 3 - 28 / (15 * kPi)) * 0.8);
  for (const double mu : {1.0, 0.7, 0.3, 0.1}) {
    const double s = std::sqrt(1 - mu * mu);
    const double g = s * (std::acos(mu) - s * mu) + 2.0 / 3 * (s / mu * (1 - s * s * s) - s);
    const double e = a * (1 + 0.8 * g / kPi), passed_on = 0.25 * mean / (1 - 0.5 * (1 - mean));
    EXPECT_NEAR(albedo(clay(0.5, 0.8), mu), 0.5 * e + passed_on * (1 - e), 1e-4) << mu;
  }
}

// Seen from the light, a rough sphere looks flatter than a Lambertian sphere: the limb is nearly as bright as
// the centre.
TEST(OrenNayarMaterial, ScattersBackTowardLight) {
  const auto back = [](double cosine) {
    Case c;
    c.light = tilted(cosine);
    c.direction = -c.light;
    return clay(0.3, 1).evaluated(c).pi_bsdf_cos.x;
  };
  EXPECT_GT(back(0.2) / back(1), 0.75);
  Case ahead;
  ahead.light = tilted(0.2);
  ahead.direction = -tilted(0.2, 0.5);
  EXPECT_LT(clay(0.3, 1).evaluated(ahead).pi_bsdf_cos.x, 0.3 * back(0.2));
}

}  // namespace
}  // namespace orrery::test
