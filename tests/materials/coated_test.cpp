#include <gtest/gtest.h>

#include <cmath>

#include "core/materials/facet_albedo.h"
#include "core/materials/sheen.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

struct Estimate {
  double mean, standard_error;
};
// Estimates the albedo for a viewer.
Estimate albedo(const Probe<double>& material, const Case& point, int draws) {
  double sum = 0, squares = 0;
  for (const auto& drawn : material.sampled(point, draws)) {
    sum += drawn.weight.x;
    squares += drawn.weight.x * drawn.weight.x;
  }
  const double mean = sum / draws;
  return {mean, std::sqrt((squares / draws - mean * mean) / draws)};
}
// Cases of one pair of directions each, over the hemisphere.
std::vector<Case> pairs() {
  std::vector<Case> cases;
  for (const double viewer : {1.0, 0.8, 0.5, 0.2, 0.03})
    for (const double light : {0.99, 0.7, 0.4, 0.1, 0.02})
      for (const double turns : {0.05, 0.25, 0.5}) {
        cases.push_back(seen_at(viewer));
        cases.back().light = tilted(light, turns);
      }
  return cases;
}

TEST(Coated, EqualsMetallicRoughnessWithoutLayers) {
  const char* const kMembers =
      "'base_color': [0.9, 0.5, 0.1], 'normal_reflectance': 0.08, 'metallic': 0.4, 'roughness': 0.3}";
  const Probe<double> plain(("{'type': 'metallic-roughness', " + std::string(kMembers)).c_str());
  const Probe<double> coated(
      ("{'type': 'coated', 'coat_roughness': 0.4, 'sheen_roughness': 0.2, " + std::string(kMembers)).c_str());
  for (const Lobes lobes : {Lobes::all, Lobes::diffuse, Lobes::non_diffuse})
    for (const Case& one : pairs()) {
      const auto a = plain.evaluated(one, lobes), b = coated.evaluated(one, lobes);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(a.pi_bsdf_cos[c], b.pi_bsdf_cos[c], 1e-13 * a.pi_bsdf_cos[c]);
      EXPECT_NEAR(a.pdf, b.pdf, 1e-12 * a.pdf);
    }
}

// The coat is D F G2 / (4 N.V N.L) with the GGX density D, Schlick's F from 0.04 and Smith's
// height-correlated G2. The base receives what the coat does not reflect.
TEST(Coated, EvaluatesFormulaOfCoat) {
  const double roughness = 0.4, alpha = roughness * roughness, share = 0.7;
  const Probe<double> coat(Json{{"type", "coated"},
                                {"base_color", 0},
                                {"normal_reflectance", 0},
                                {"roughness", 1},
                                {"coat", share},
                                {"coat_roughness", roughness}});
  const Probe<double> bare(
      Json{{"type", "coated"}, {"base_color", 0}, {"normal_reflectance", 0}, {"roughness", 1}});
  const FacetAlbedo<double> reflected =
      mirrored_albedo(alpha, [](double cosine) { return 0.04 + 0.96 * std::pow(1 - cosine, 5); });
  for (const Case& one : pairs()) {
    const Vec3d viewer = -one.direction, half = normalize(viewer + one.light);
    const double nv = viewer.z, nl = one.light.z, nh = half.z;
    const double d = alpha * alpha / (std::numbers::pi * std::pow(nh * nh * (alpha * alpha - 1) + 1, 2));
    const double f = 0.04 + 0.96 * std::pow(1 - dot(viewer, half), 5);
    const auto lambda = [&](double c) { return (std::sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1) / 2; };
    const double expected = share * d * f / (1 + lambda(nv) + lambda(nl)) / (4 * nv) * std::numbers::pi;
    const double passed = 1 - share * std::max(reflected.at(nv), reflected.at(nl));
    const double base = bare.evaluated(one).pi_bsdf_cos.x;  // Schlick's rim of the base
    EXPECT_NEAR(coat.evaluated(one).pi_bsdf_cos.x, expected + base * passed, 1e-9 * expected);
  }
}

// Estevez and Kulla, with their coefficients of Smith's function for alpha between 0 and 1.
TEST(Coated, EvaluatesFormulaOfSheen) {
  for (const double roughness : {0.3, 0.6, 1.0}) {
    const double alpha = roughness * roughness;
    const auto f = [&](double x) {
      const double t = (1 - alpha) * (1 - alpha);
      const auto mix = [&](double smooth, double rough) { return t * smooth + (1 - t) * rough; };
      return mix(25.3245, 21.5473) / (1 + mix(3.32435, 3.82987) * std::pow(x, mix(0.16801, 0.19823))) +
             mix(-1.27393, -1.97760) * x + mix(-4.85967, -4.32054);
    };
    const auto lambda = [&](double x) { return std::exp(x < 0.5 ? f(x) : 2 * f(0.5) - f(1 - x)); };
    const Probe<double> cloth(Json{{"type", "coated"},
                                   {"base_color", 0},
                                   {"normal_reflectance", 0},
                                   {"sheen_color", {0.8, 0.4, 0.2}},
                                   {"sheen_roughness", roughness}});
    for (const Case& one : pairs()) {
      const Vec3d viewer = -one.direction, half = normalize(viewer + one.light);
      const double sine = std::sqrt(std::max(0.0, 1 - half.z * half.z));
      const double density = (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * std::numbers::pi);
      const double visible =
          std::min(1.0, 1 / ((1 + lambda(viewer.z) + lambda(one.light.z)) * 4 * viewer.z * one.light.z));
      const double expected = density * visible * one.light.z * std::numbers::pi;
      const Vec3d found = cloth.evaluated(one, Lobes::diffuse).pi_bsdf_cos;
      EXPECT_NEAR(found.x, 0.8 * expected, 1e-9 * expected + 1e-12);
      EXPECT_NEAR(found.z, 0.2 * expected, 1e-9 * expected + 1e-12);
    }
  }
}

// The series of the albedo follows a finer quadrature, and no fibres reflect more light than arrives.
TEST(Coated, TabulatesAlbedoOfSheen) {
  double worst = 0;
  for (const double roughness : {0.07, 0.1, 0.15, 0.2, 0.5, 1.0}) {
    const SheenLayer<double> layer = make_sheen_layer(std::max(kMinSheenAlpha, roughness * roughness));
    for (const double mu : {0.01, 0.03, 0.1, 0.3, 0.6, 1.0}) {
      constexpr int kSteps = 200;
      const Vec3d viewer = tilted(mu);
      double sum = 0;
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const double root = (i + 0.5) / kSteps, cosine = root * root * root;
          sum += layer.fibres.brdf(viewer, tilted(cosine, (j + 0.5) / kSteps / 2)) * cosine * 3 * root * root;
        }
      sum *= 2 * std::numbers::pi / (kSteps * kSteps);
      worst = std::max(worst, std::abs(layer.albedo.at(mu) - sum));
      EXPECT_LE(sum, 1) << roughness << " " << mu;
    }
  }
  EXPECT_LT(worst, 2e-3);
}

// A layer passes to a smooth base what it does not reflect, and the base reflects it at the same angle.
TEST(Coated, ReflectsAllLightOverWhiteMirror) {
  for (const char* layer : {"'coat': 1", "'coat': 0.5, 'coat_roughness': 0.3", "'sheen_color': 1"}) {
    const Probe<double> white(
        ("{'type': 'coated', 'base_color': 1, 'metallic': 1, 'roughness': 0, " + std::string(layer) + "}")
            .c_str());
    for (const double cosine : {1.0, 0.7, 0.4, 0.1})
      EXPECT_NEAR(albedo(white, seen_at(cosine), 250'000).mean, 1, 4e-3) << layer << " " << cosine;
  }
}

TEST(Coated, CreatesNoEnergy) {
  for (const double roughness : {0.0, 0.3, 1.0})
    for (const double metallic : {0.0, 1.0})
      for (const double coat_roughness : {0.0, 0.5, 1.0})
        for (const double sheen_roughness : {0.05, 0.5, 1.0}) {
          const Probe<double> white(Json{{"type", "coated"},
                                         {"base_color", 1},
                                         {"metallic", metallic},
                                         {"roughness", roughness},
                                         {"coat", 1},
                                         {"coat_roughness", coat_roughness},
                                         {"sheen_color", 1},
                                         {"sheen_roughness", sheen_roughness}});
          for (const double cosine : {1.0, 0.4, 0.1, 0.02}) {
            const auto [found, error] = albedo(white, seen_at(cosine), 20'000);
            EXPECT_LT(found, 1 + 2e-3 + 4 * error) << roughness << " " << metallic << " " << coat_roughness
                                                   << " " << sheen_roughness << " " << cosine;
            EXPECT_GT(found, 0.6);
          }
        }
}

}  // namespace
}  // namespace orrery::test
