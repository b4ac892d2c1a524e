#include "core/study/difference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

// Compares image differences with closed forms.
namespace orrery::test {
namespace {

TEST(Difference, EqualsUniformShift) {
  const std::array<float, 6> reference{0.125f, 0.25f, 0.5f, 0.75f, 0, 0.375f};
  std::array<float, 6> picture = reference;
  for (float& value : picture) value += 0.125f;
  const Difference d = difference(picture, reference);
  EXPECT_DOUBLE_EQ(d.rmse, 0.125);
  EXPECT_DOUBLE_EQ(d.bias, 0.125);
  EXPECT_DOUBLE_EQ(d.mean_absolute, 0.125);
  EXPECT_DOUBLE_EQ(d.largest, 0.125);
  EXPECT_DOUBLE_EQ(d.cut_mse, 0.125 * 0.125);
  EXPECT_EQ(d.non_finite, 0U);
}

TEST(Difference, ReportsSignedBias) {
  const std::array<float, 2> reference{0.5f, 0.5f};
  const Difference balanced = difference(std::array{0.75f, 0.25f}, reference);
  EXPECT_EQ(balanced.bias, 0);
  EXPECT_EQ(balanced.rmse, 0.25);
  EXPECT_EQ(difference(std::array{0.25f, 0.5f}, reference).bias, -0.125);
}

TEST(Difference, RegularizesRelativeErrorOfDarkPixels) {
  const double in_the_dark = difference(std::array{0.01f}, std::array{0.0f}).relative_mse;
  EXPECT_NEAR(in_the_dark, 1, 1e-6);
  const double in_the_light = difference(std::array{1.01f}, std::array{1.0f}).relative_mse;
  EXPECT_NEAR(in_the_light, std::pow(0.01 / 1.01, 2), 1e-8);
}

TEST(Difference, ClampsToDisplayRange) {
  const Difference d = difference(std::array{7.0f, -1.0f, 0.5f}, std::array{3.0f, 0.0f, 0.5f});
  EXPECT_EQ(d.cut_mse, 0);
  EXPECT_EQ(d.largest, 4);
}

TEST(Difference, CountsAndExcludesNonFiniteValues) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Difference d = difference(std::array{nan, 0.5f, inf, 1.0f}, std::array{0.0f, 0.25f, 0.0f, nan});
  EXPECT_EQ(d.non_finite, 3U);
  EXPECT_EQ(d.rmse, 0.25);
  EXPECT_EQ(difference(std::array{nan}, std::array{nan}).rmse, 0);
}

}  // namespace
}  // namespace orrery::test
