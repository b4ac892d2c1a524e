#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/covers.h"
#include "tests/support/materials.h"

// Tests the albedo of materials under uniform illumination.
namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

Vec3d mean_weight(const Probe<double>& material, const Case& point, int draws = 250'000) {
  Vec3d sum;
  for (const auto& drawn : material.sampled(point, draws)) sum = sum + drawn.weight;
  return sum / draws;
}
const double kCosines[] = {1, 0.7, 0.4, 0.1};

TEST(Glass, ConservesEnergy) {
  covers("light-30");
  double worst = 0;
  for (const double alpha : {0.0, 0.0011, 0.04, 0.1, 0.25, 0.5, 1.0}) {
    const Probe<double> glass(Json{{"type", "glass"}, {"ior", 1.5}, {"roughness", std::sqrt(alpha)}});
    for (const double cosine : kCosines)
      for (const double side : {1.0, -1.0}) {
        const double found = mean_weight(glass, seen_at(cosine, side)).x;
        EXPECT_NEAR(found, 1, 3e-3) << alpha << " " << cosine << " " << side;
        worst = std::max(worst, std::abs(found - 1));
      }
  }
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(Glass, ConservesEnergyAtOtherIndices) {
  for (const double ior : {0.75, 1.1, 2.4, 4.0})
    for (const double roughness : {0.3, 0.7, 1.0}) {
      const Probe<double> glass(Json{{"type", "glass"}, {"ior", ior}, {"roughness", roughness}});
      for (const double cosine : {0.9, 0.3})
        for (const double side : {1.0, -1.0})
          EXPECT_NEAR(mean_weight(glass, seen_at(cosine, side)).x, 1, 6e-3)
              << ior << " " << roughness << " " << cosine << " " << side;
    }
}

TEST(Glass, EqualsRefractiveIfSmooth) {
  const Probe<double> glass("{'type': 'glass', 'ior': 1.5, 'filter': [0.9, 0.5, 0.1]}");
  const Probe<double> clear(
      "{'type': 'refractive', 'ior': 1.5, 'fresnel': 'exact', 'filter': [0.9, 0.5, 0.1]}");
  for (const double side : {1.0, -1.0}) {
    const Case point = seen_at(0.6, side);
    const auto mine = glass.specular(point), other = clear.specular(point);
    EXPECT_EQ(mine.reflectance, other.reflectance);
    EXPECT_EQ(mine.transmittance, other.transmittance);
    EXPECT_EQ(mine.refracted, other.refracted);
    EXPECT_EQ(mine.filter, other.filter);
    EXPECT_EQ(glass.evaluated(point).pdf, 0);
    const auto a = glass.sampled(point, 200), b = clear.sampled(point, 200);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].direction, b[i].direction);
      EXPECT_EQ(a[i].weight, b[i].weight);
      EXPECT_EQ(a[i].pdf, 0);
    }
  }
}

// The transmittance of a channel over two metres is the square of its transmittance over one metre.
TEST(Glass, FiltersLightInsideIfRough) {
  const Probe<double> glass("{'type': 'glass', 'roughness': 0.5, 'filter': [0.9, 0.5, 0.1]}");
  const Probe<double> clear("{'type': 'glass', 'roughness': 0.5}");
  Case point = seen_at(0.9, -1);
  point.t = 2;
  for (const double z : {1.0, -1.0}) {
    point.light = Vec3d(0, 0, z);
    const auto filtered = glass.evaluated(point).pi_bsdf_cos, plain = clear.evaluated(point).pi_bsdf_cos;
    EXPECT_NEAR(filtered.x / plain.x, 0.81, 1e-12);
    EXPECT_NEAR(filtered.z / plain.z, 0.01, 1e-12);
  }
  point.side = 1;
  EXPECT_EQ(glass.evaluated(point).pi_bsdf_cos, clear.evaluated(point).pi_bsdf_cos);
}

TEST(Plastic, ReflectsAllLightIfWhite) {
  for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0})
    for (const double ior : {1.0, 1.5, 2.0}) {
      const Probe<double> white(
          Json{{"type", "plastic"}, {"reflectance", 1}, {"ior", ior}, {"roughness", roughness}});
      for (const double cosine : kCosines) {
        const Case seen = seen_at(cosine);
        EXPECT_NEAR(mean_weight(white, seen).x, 1, 3e-3) << roughness << " " << ior << " " << cosine;
        const double by_rays = white.specular(seen).reflectance.x;
        EXPECT_NEAR(white.ambient(seen).x, 1 - by_rays, 1e-12) << roughness << " " << ior << " " << cosine;
      }
    }
}

// If the interpolated normal faces away from the viewer, the reflectance of the coat uses the flipped normal.
TEST(Plastic, FlipsBackfacingNormalOfCoat) {
  const Probe<double> plastic("{'type': 'plastic', 'roughness': 0}");
  Case away = seen_at(0.9);
  away.normal = tilted(-0.1, 0.5);
  Case flat = seen_at(0.9);
  EXPECT_EQ(plastic.specular(away).reflectance, plastic.specular(flat).reflectance);
}

TEST(MetallicRoughness, KeepsAlbedoBelowLimitIfStrict) {
  for (const double roughness : {0.3, 0.5, 1.0}) {
    const Json strict{
        {"type", "metallic-roughness"}, {"base_color", 1}, {"roughness", roughness}, {"strict", true}};
    const Probe<double> probe(strict);
    for (const double cosine : {1.0, 0.3, 0.02, 0.01})
      EXPECT_LE(mean_weight(probe, seen_at(cosine), 1'000'000).x, probe.limits().albedo.x + 0.012)
          << roughness << " " << cosine;
  }
}

TEST(Ambient, StaysBelowMaterialLimit) {
  std::vector<Json> materials;
  for (const char* type : {"rough", "lambert", "oren-nayar", "translucent"})
    materials.push_back({{"type", type}});
  for (const double roughness : {0.0, 0.1, 0.3, 1.0}) {
    for (const char* type : {"glass", "metallic-roughness"})
      materials.push_back({{"type", type}, {"roughness", roughness}});
    for (const double layer : {0.0, 1.0})
      materials.push_back({{"type", "coated"},
                           {"base_color", 1},
                           {"roughness", roughness},
                           {"coat", layer},
                           {"coat_roughness", roughness},
                           {"sheen_color", 1 - layer}});
    materials.push_back({{"type", "metal"}, {"name", "iron"}, {"roughness", roughness}});
    for (const double reflectance : {0.0, 0.5, 1.0})
      materials.push_back({{"type", "plastic"}, {"reflectance", reflectance}, {"roughness", roughness}});
  }
  for (const Json& material : materials) {
    const Probe<double> probe(material);
    const Vec3d most = probe.limits().ambient;
    for (const double cosine : kCosines) {
      const Vec3d sent = probe.ambient(seen_at(cosine));
      for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(sent[c], most[c] + 1e-12) << material << " " << cosine;
    }
  }
}

// A smooth coat has a closed form: F + (1 - F) rho (1 - F_in) / (1 - rho F_in), with F_in the mean internal
// reflectance.
TEST(Plastic, MatchesClosedFormUnderSmoothCoat) {
  const Probe<double> plastic("{'type': 'plastic', 'reflectance': [0.2, 0.5, 0.9], 'roughness': 0}");
  constexpr double kOutside = 0.0917786, kInside = 1 - (1 - kOutside) / 2.25, kHead = 0.04;
  const Vec3d found = mean_weight(plastic, seen_at(1));
  const auto expected = [&](double rho) {
    return kHead + (1 - kHead) * rho * (1 - kInside) / (1 - rho * kInside);
  };
  EXPECT_NEAR(found.x, expected(0.2), 2e-3);
  EXPECT_NEAR(found.y, expected(0.5), 2e-3);
  EXPECT_NEAR(found.z, expected(0.9), 2e-3);
  EXPECT_NEAR(plastic.specular(seen_at(1)).reflectance.x, kHead, 1e-12);
}

TEST(MetallicRoughness, HasDocumentedAlbedoIfStrict) {
  covers("light-31");
  const Probe<double> strict(
      "{'type': 'metallic-roughness', 'base_color': 1, 'roughness': 0.5, 'strict': true}");
  EXPECT_NEAR(mean_weight(strict, seen_at(1), 2'000'000).x, .99658, 1e-3);
  EXPECT_NEAR(mean_weight(strict, seen_at(0.5), 2'000'000).x, 1.01099, 1e-3);
  EXPECT_NEAR(mean_weight(strict, seen_at(0.1), 2'000'000).x, 1.1096, 1e-3);
}

TEST(MetallicRoughness, CreatesNoEnergy) {
  covers("light-31");
  for (const double roughness : {0.0, 0.2, 0.5, 0.8, 1.0})
    for (const double metallic : {0.0, 0.5, 1.0}) {
      const Probe<double> white(Json{{"type", "metallic-roughness"},
                                     {"base_color", 1},
                                     {"metallic", metallic},
                                     {"roughness", roughness}});
      for (const double cosine : kCosines) {
        const double found = mean_weight(white, seen_at(cosine)).x;
        EXPECT_LT(found, 1 + 2e-3) << roughness << " " << metallic << " " << cosine;
        if (metallic == 0.5) continue;  // the metallic half absorbs some light
        EXPECT_GT(found, 1 - 4e-3) << roughness << " " << metallic << " " << cosine;
      }
    }
}

// Compares the mean weight of samples with the integral of evaluate() over the hemisphere.
TEST(CookTorrance, MatchesQuadratureOfFormula) {
  const Probe<double> gold(
      "{'type': 'cook-torrance', 'n': [0.156, 0.424, 1.383], 'k': [3.602, 2.472, 1.915], 'slope': 0.3}");
  for (const double cosine : {1.0, 0.5}) {
    constexpr int kSteps = 400;
    std::vector<Case> cases;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        cases.push_back(seen_at(cosine));
        cases.back().light = tilted(std::sqrt((i + 0.5) / kSteps), (j + 0.5) / kSteps);
      }
    Vec3d sum;  // integral of pi_bsdf_cos / cosine over the squared cosine
    const auto found = gold.evaluated(cases);
    for (std::size_t i = 0; i < cases.size(); ++i)
      sum = sum + found[i].pi_bsdf_cos / (cases[i].light.z * kSteps * kSteps);
    const Vec3d mean = mean_weight(gold, seen_at(cosine));
    EXPECT_NEAR(mean.x, sum.x, 2e-3);
    EXPECT_NEAR(mean.z, sum.z, 2e-3);
    EXPECT_LT(mean.x, 1);
  }
}

TEST(Translucent, SplitsLightBetweenReflectionAndTransmission) {
  const Probe<double> paper("{'type': 'translucent', 'reflectance': [0.4, 0.3, 0.2], 'transmittance': 0.5}");
  Vec3d back, on;
  constexpr int kDraws = 200'000;
  for (const auto& drawn : paper.sampled(seen_at(0.3), kDraws))
    (drawn.direction.z > 0 ? back : on) = (drawn.direction.z > 0 ? back : on) + drawn.weight / kDraws;
  EXPECT_NEAR(length(back - Vec3d(0.4, 0.3, 0.2)), 0, 3e-3);
  EXPECT_NEAR(length(on - Vec3d(0.5)), 0, 3e-3);
}

TEST(Materials, StoresLargestAlbedoInSceneFacts) {
  const auto most = [](const char* material) {
    const auto scene =
        load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1, 'material': 'it'}]"),
                        Json{{"materials", {{"white", nullptr}, {"it", json(material)}}}}));
    return scene->facts.max_albedo.value;
  };
  EXPECT_NEAR(most("{'type': 'metallic-roughness', 'base_color': 1, 'roughness': 0.5, 'strict': true}"),
              1.155, 0.01);
  EXPECT_EQ(most("{'type': 'metallic-roughness', 'base_color': 1, 'roughness': 0.5}"), 1);
  EXPECT_EQ(most("{'type': 'rough', 'kd': 0.5, 'ks': 0.5, 'shininess': 20}"), 1);
  EXPECT_NEAR(most("{'type': 'rough', 'kd': 0.5, 'ks': 0.9, 'shininess': 2}"), 0.5 + 0.9 * 1.5, 1e-12);
}

TEST(Metal, UsesMeasuredIndicesOfGold) {
  const Probe<double> named("{'type': 'metal', 'name': 'gold'}");
  const Probe<double> given("{'type': 'metal', 'n': [0.156, 0.424, 1.383], 'k': [3.602, 2.472, 1.915]}");
  EXPECT_EQ(named.ambient(), given.ambient());
  EXPECT_GT(named.ambient().x, named.ambient().z + 0.4);
}

}  // namespace
}  // namespace orrery::test
