#include <gtest/gtest.h>

#include "core/materials/fresnel.h"
#include "tests/support/pictures.h"

// Tests the energy account of materials.
namespace orrery::test {
namespace {

RenderRequest account(const char* technique, int samples = 1) {
  RenderRequest request = in_double(size(32, 32));
  request.technique = technique;
  request.samples = samples;
  request.energy = true;
  return request;
}

// A wall in front of a parallel camera, with this material, lit from everywhere.
Json wall(const Json& material) {
  return scene_with(
      json("{'type': 'rectangle', 'corner': [-9, -9, 0], 'edge_u': [18, 0, 0], 'edge_v': [0, 18, 0],"
           " 'material': 'wall'}"),
      {{"materials", {{"wall", material}}},
       {"camera", {{"type", "orthographic"}, {"eye", {0, 0, 4}}, {"look_at", {0, 0, 0}}, {"height", 2}}},
       {"background", {1, 1, 1}}});
}

EnergySums energy_of(const Json& scene, const RenderRequest& request, std::size_t hit_materials = 1) {
  const RenderStats stats = render(scene, request).stats;
  EnergySums sums;
  std::size_t hit = 0;
  for (const EnergySums& material : stats.counts.energy) {
    hit += material.hits > 0;
    sums.add(material);
  }
  EXPECT_EQ(hit, hit_materials);
  return sums;
}

TEST(Energy, SeparatesPartsOfEachMaterial) {
  for (const char* technique : {"raycast", "whitted", "distributed", "path"}) {
    SCOPED_TRACE(technique);
    const EnergySums matt =
        energy_of(wall({{"type", "lambert"}, {"reflectance", {0.2, 0.5, 0.8}}}), account(technique));
    EXPECT_EQ(matt.hits, 1024u);
    EXPECT_NEAR(matt.mean(matt.diffuse), 0.5, 1e-6);
    EXPECT_EQ(matt.specular, 0);
    EXPECT_EQ(matt.transmitted, 0);
    EXPECT_NEAR(matt.absorbed(), 0.5, 1e-6);

    const Json mirror = {{"type", "reflective"}, {"n", {0.2, 0.9, 1.1}}, {"k", {3.9, 2.5, 2.4}}};
    const EnergySums metal = energy_of(wall(mirror), account(technique));
    const double expected =
        (normal_reflectance(0.2, 3.9) + normal_reflectance(0.9, 2.5) + normal_reflectance(1.1, 2.4)) / 3;
    EXPECT_NEAR(metal.mean(metal.specular), expected, 1e-6);
    EXPECT_NEAR(metal.absorbed(), 1 - expected, 1e-6);
  }
}

TEST(Energy, SumsToOneForMaterialsThatAbsorbNothing) {
  const Json materials[] = {{{"type", "refractive"}, {"ior", 1.5}, {"fresnel", "exact"}},
                            {{"type", "refractive"}, {"ior", 0.6}},
                            {{"type", "glass"}, {"ior", 1.4}},
                            {{"type", "lambert"}, {"reflectance", 1}},
                            {{"type", "translucent"}, {"reflectance", 0.25}, {"transmittance", 0.75}}};
  for (const Json& material : materials) {
    SCOPED_TRACE(material.dump());
    Json scene = wall(material);
    scene["objects"][0] = {{"type", "sphere"}, {"center", {0, 0, 0}}, {"radius", 0.9}, {"material", "wall"}};
    for (const char* technique : {"whitted", "path"}) {
      const EnergySums sums = energy_of(scene, account(technique, 4));
      EXPECT_GT(sums.hits, 1000u);
      EXPECT_NEAR(sums.absorbed(), 0, 1e-6) << technique;
    }
  }
}

TEST(Energy, MeasuresTransmittedShare) {
  const EnergySums leaf = energy_of(
      wall({{"type", "translucent"}, {"reflectance", 0.3}, {"transmittance", 0.6}}), account("path", 64));
  EXPECT_NEAR(leaf.mean(leaf.diffuse + leaf.transmitted), 0.9, 1e-6);
  EXPECT_NEAR(leaf.mean(leaf.transmitted), 0.6, 0.01);
}

TEST(Energy, IsNegativeIfMaterialCreatesEnergy) {
  Json scene = wall({{"type", "metallic-roughness"},
                     {"base_color", 1},
                     {"metallic", 0},
                     {"roughness", 0.5},
                     {"strict", true}});
  scene["camera"] = {{"type", "orthographic"}, {"eye", {4, 0, 0.4}}, {"look_at", {0, 0, 0}}, {"height", 0.2}};
  const EnergySums sums = energy_of(scene, account("path", 256));
  EXPECT_NEAR(sums.absorbed(), -0.11, 0.01) << "cosine 0.1";
}

TEST(Energy, IsIndependentOfThreads) {
  const Json scene = sample("glass");
  const auto energy = [&](int threads) {
    return render(scene, account("path", 4), threads).stats.counts.energy;
  };
  const std::vector<EnergySums> one = energy(1), three = energy(3);
  ASSERT_EQ(one.size(), three.size());
  ASSERT_FALSE(one.empty());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].hits, three[i].hits);
    EXPECT_EQ(one[i].diffuse, three[i].diffuse);
    EXPECT_EQ(one[i].specular, three[i].specular);
    EXPECT_EQ(one[i].transmitted, three[i].transmitted);
  }
}

TEST(Energy, IsKeptOnRequestOnly) {
  RenderRequest request = account("path");
  request.energy = {};
  EXPECT_TRUE(render(sample("glass"), request).stats.counts.energy.empty());
  EXPECT_TRUE(render(sample("glass"), account("phong")).stats.counts.energy.empty());
}

}  // namespace
}  // namespace orrery::test
