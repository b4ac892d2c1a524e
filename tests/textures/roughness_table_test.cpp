#include "core/materials/roughness_table.h"

#include <gtest/gtest.h>

#include "core/materials/glass.h"
#include "core/materials/metal.h"
#include "core/materials/metallic_roughness.h"
#include "core/materials/plastic.h"

namespace orrery::test {
namespace {

// Returns the inputs with the table's values at a roughness.
template <class Inputs>
Inputs interpolated(Inputs inputs, const RoughnessTable<double>& table, double roughness) {
  double* const after = &inputs.roughness + 1;
  table.interpolate(roughness, [&](std::size_t k, double value) { after[k] = value; });
  return inputs;
}

// Compares one albedo series with the series computed for the same roughness.
template <class Inputs, class Series>
double largest_error(Inputs inputs, const Series& series) {
  const RoughnessTable<double> table(inputs, kMinTexturedRoughness, 1);
  double worst = 0;
  for (const double roughness : {0.04, 0.1, 0.23, 0.37, 0.5, 0.66, 0.81, 0.99}) {
    const Inputs found = interpolated(inputs, table, roughness);
    inputs.tabulate(roughness);
    EXPECT_NEAR(found.alpha, inputs.alpha, 1e-12);
    for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.1})
      worst = std::max(worst, std::abs(series(found).at(cosine) - series(inputs).at(cosine)));
  }
  return worst;
}

TEST(RoughnessTable, InterpolatesAlbedos) {
  MetalInputs<double> metal{Vec3d(0.2), Vec3d(3), 0.5, 0, {}};
  EXPECT_LT(largest_error(metal, [](const auto& inputs) { return inputs.albedo; }), 1e-3);
  PlasticInputs<double> plastic{Vec3d(0.5), 1.5, 0.5, 0, {}, 0};
  EXPECT_LT(largest_error(plastic, [](const auto& inputs) { return inputs.mirror; }), 1e-3);
  MetallicRoughnessInputs<double> both{Vec3d(0.5), Vec3d(0.04), 0, 0, 0.5, 0, {}, {}};
  EXPECT_LT(largest_error(both, [](const auto& inputs) { return inputs.grazing; }), 1e-3);
  GlassInputs<double> glass{Vec3d(1), 1.5, 0, 0.5, 0, {}, {}, 0, 0};
  EXPECT_LT(largest_error(glass, [](const auto& inputs) { return inputs.outside; }), 2e-3);
  EXPECT_LT(largest_error(glass, [](const auto& inputs) { return inputs.inside; }), 4e-3);
}

TEST(RoughnessTable, IsExactForOneRoughness) {
  MetalInputs<double> metal{Vec3d(0.2), Vec3d(3), 0.5, 0, {}};
  const RoughnessTable<double> table(metal, 0.5, 0.5);
  const auto found = interpolated(metal, table, 0.5);
  metal.tabulate(0.5);
  EXPECT_EQ(found.albedo.mean, metal.albedo.mean);
  EXPECT_EQ(found.albedo.coefficients, metal.albedo.coefficients);
}

}  // namespace
}  // namespace orrery::test
