#include "core/materials/metal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/materials/microfacet.h"
#include "tests/support/covers.h"
#include "tests/support/materials.h"

namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

// Returns a metal that absorbs no light: for n = 0, Fresnel's equations give a reflectance of 1.
Probe<double> perfect_mirror(double alpha) {
  return Probe<double>(
      Json{{"type", "metal"}, {"n", {0, 0, 0}}, {"k", {1, 1, 1}}, {"roughness", std::sqrt(alpha)}});
}

// Returns the single-scattering albedo, integrated over half vectors of density D cos. The squared tangent of
// the half vector's angle is alpha^2 u / (1 - u).
double single_albedo(double alpha, double cosine) {
  constexpr int kSteps = 1000;
  const Ggx<double> facets{alpha};
  const Vec3d viewer = tilted(cosine);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double u = (i + 0.5) / kSteps;
      const Vec3d half = tilted(std::sqrt((1 - u) / (1 - u + alpha * alpha * u)), (j + 0.5) / (2 * kSteps));
      const double along = dot(viewer, half);
      const Vec3d light = mirrored_about(viewer, half);
      if (along <= 0 || light.z <= 0) continue;
      const double density = facets.half(viewer, light).density;
      sum += facets.brdf(viewer, light, density) * light.z * 4 * along / (density * half.z);
    }
  return sum / (kSteps * kSteps);
}

TEST(Microfacets, MatchesSingleScatteringAlbedo) {
  covers("light-27");
  EXPECT_NEAR(single_albedo(1, 1), 1 - std::numbers::ln2, 1e-4);
  EXPECT_NEAR(single_albedo(0.5, 1), .68785, 1e-4);
  EXPECT_NEAR(single_albedo(0.5, 0.5), .69825, 1e-4);
  EXPECT_NEAR(single_albedo(0.25, 1), .91581, 1e-4);
  EXPECT_NEAR(single_albedo(0.25, 0.5), .85726, 1e-4);
  EXPECT_NEAR(single_albedo(0.1, 1), .98831, 1e-4);
}

// The integral of D cos over the hemisphere is 1.
TEST(Microfacets, ProjectsToUnitArea) {
  constexpr int kSteps = 4000;
  for (const double alpha : {0.05, 0.3, 1.0}) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double r = (i + 0.5) / kSteps;
      const Vec3d normal = tilted(1 - r * r);
      sum += Ggx<double>{alpha}.half(normal, normal).density * normal.z * 4 * std::numbers::pi * r / kSteps;
    }
    EXPECT_NEAR(sum, 1, 1e-4) << alpha;
  }
}

TEST(Microfacets, AlbedoCurveMatchesQuadrature) {
  covers("light-27");
  double worst = 0;
  for (const double alpha : {0.001, 0.015, 0.05, 0.25, 0.77, 1.0}) {
    const GgxAlbedo<double> curve = ggx_albedo(alpha);
    for (const double cosine : {0.2, 0.35, 0.5, 0.75, 1.0})
      worst = std::max(worst, std::abs(curve.at(cosine) - single_albedo(alpha, cosine)));
  }
  EXPECT_LT(worst, 1e-3);
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(Microfacets, MatchesDocumentedMeanAlbedo) {
  struct Row {
    double alpha, mean;
  };
  for (const Row& row : {Row{.1, .9722}, Row{.25, .8825}, Row{.5, .7003}, Row{.75, .5364}, Row{1, .4092}})
    EXPECT_NEAR(ggx_albedo(row.alpha).mean, row.mean, 5e-4) << row.alpha;
}

TEST(Metal, ConservesEnergy) {
  covers("light-28");
  double worst = 0;
  for (const double alpha : {0.0011, 0.04, 0.25, 0.6, 1.0})
    for (const double cosine : {1.0, 0.6, 0.3, 0.1, 0.03}) {
      constexpr int kDraws = 1'000'000;
      double sum = 0;
      for (const auto& drawn : perfect_mirror(alpha).sampled(seen_at(cosine), kDraws)) sum += drawn.weight.x;
      EXPECT_NEAR(sum / kDraws, 1, 2e-3) << alpha << " " << cosine;
      worst = std::max(worst, std::abs(sum / kDraws - 1));
    }
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(Metal, AddsMultipleScattering) {
  covers("light-29");
  const GgxAlbedo<double> curve = ggx_albedo(1);
  const double passed_on = (1 - curve.at(1)) * multiple_scattering_reflectance(0.9, curve.mean);
  EXPECT_NEAR(0.9 * single_albedo(1, 1) + passed_on, .7668, 2e-3);
}

// The albedo of gold with roughness 1 is the sum of single scattering with F and the lobe of Kulla and Conty
// with the mean of F. The test integrates both independently of the material.
TEST(Metal, ColoursMultipleScattering) {
  const Probe<double> gold(
      "{'type': 'metal', 'n': [0.143, 0.375, 1.442], 'k': [3.983, 2.386, 1.603], "
      "'roughness': 1}");
  constexpr int kDraws = 1'000'000;
  Vec3d sum;
  for (const auto& drawn : gold.sampled(seen_at(1), kDraws)) sum = sum + drawn.weight;
  const auto expected = [](double n, double k) {
    double mean_f = 0, once = 0;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
      const double u = (i + 0.5) / kSteps;
      mean_f += fresnel_conductor(n, k, std::sqrt(u)) / kSteps;
      // alpha 1, normal view: half vectors are uniform in cos^2 and G2 / G1 = 2 z / (z + 1) with z the
      // light's cosine.
      const double c2 = 1 - u, z = 2 * c2 - 1;
      if (z > 0) once += fresnel_conductor(n, k, std::sqrt(c2)) * 2 * z / (z + 1) / kSteps;
    }
    const double e = 1 - std::numbers::ln2;
    return once + (1 - e) * mean_f * mean_f * .4092 / (1 - mean_f * (1 - .4092));
  };
  EXPECT_NEAR(sum.x / kDraws, expected(0.143, 3.983), 2e-3);
  EXPECT_NEAR(sum.y / kDraws, expected(0.375, 2.386), 2e-3);
  EXPECT_NEAR(sum.z / kDraws, expected(1.442, 1.603), 2e-3);
}

TEST(Metal, EqualsMirrorIfSmooth) {
  const Probe<double> smooth(
      "{'type': 'metal', 'n': [0.143, 0.375, 1.442], 'k': [3.983, 2.386, 1.603], "
      "'roughness': 0.03}");
  const Probe<double> mirror(
      "{'type': 'reflective', 'n': [0.143, 0.375, 1.442], 'k': [3.983, 2.386, 1.603], "
      "'fresnel': 'exact'}");
  const Case point = seen_at(0.4);
  EXPECT_EQ(smooth.specular(point).reflectance, mirror.specular(point).reflectance);
  EXPECT_EQ(smooth.evaluated(point).pdf, 0);
  EXPECT_EQ(smooth.ambient(), Vec3d(0));
  const auto drawn = smooth.sampled(point, 100), expected = mirror.sampled(point, 100);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_EQ(drawn[i].direction, expected[i].direction);
    EXPECT_EQ(drawn[i].weight, expected[i].weight);
    EXPECT_EQ(drawn[i].pdf, 0);
  }
}

TEST(Metal, HasNoSpecularLobeIfRough) {
  const Probe<double> rough("{'type': 'metal', 'n': [0.2, 0.9, 1.1], 'k': [3.9, 2.4, 2.1]}");
  const auto specular = rough.specular(seen_at(0.4));
  EXPECT_EQ(specular.reflectance, Vec3d(0));
  EXPECT_EQ(specular.transmittance, Vec3d(0));
  EXPECT_EQ(specular.filter, Vec3d(1));
  EXPECT_NEAR(rough.ambient().x, normal_reflectance(0.2, 3.9), 1e-12);
}

}  // namespace
}  // namespace orrery::test
