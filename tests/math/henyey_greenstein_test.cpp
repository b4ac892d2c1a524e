#include "core/math/henyey_greenstein.h"

#include <gtest/gtest.h>

#include <cmath>

namespace orrery::test {
namespace {

// Inverse of the cumulative probability, as published, in long double.
long double published_cosine(long double g, long double u) {
  const long double q = (1 - g * g) / (1 - g + 2 * g * u);
  return (1 + g * g - q * q) / (2 * g);
}

// The formula divides a sum of terms of size 1 by the square of q = 1 + g (2u - 1), so rounding errors grow
// by q^-2.
TEST(HenyeyGreenstein, EqualsPublishedInverse) {
  constexpr double kRoundings = 4;
  for (const double g : {-0.99, -0.7, -0.1, 0.05, 0.3, 0.75, 0.9, 0.99})
    for (int i = 0; i < 1000; ++i) {
      const double u = (i + 0.5) / 1000, q = 1 + g * (2 * u - 1);
      const auto expected = static_cast<double>(published_cosine(g, u));
      EXPECT_NEAR(henyey_greenstein_cosine(g, u), expected, kRoundings * 0x1p-52 * (1 + 1 / (q * q)))
          << g << " " << u;
      EXPECT_NEAR(henyey_greenstein_cosine(static_cast<float>(g), static_cast<float>(u)), expected,
                  kRoundings * 0x1p-23 * (1 + 1 / (q * q)))
          << g << " " << u;
    }
}

TEST(HenyeyGreenstein, HasMeanCosineG) {
  for (const double g : {-0.99, -0.5, -1e-9, 0.0, 1e-9, 1e-4, 0.5, 0.9, 0.99}) {
    constexpr int kSteps = 200'000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += henyey_greenstein_cosine(g, (i + 0.5) / kSteps);
    EXPECT_NEAR(sum / kSteps, g, 2e-9) << g;
  }
}

TEST(HenyeyGreenstein, TurnsDirectionByCosine) {
  for (const Vec3d& direction : {Vec3d(0, 0, 1), Vec3d(0, 0, -1), safe_normalize(Vec3d(0.3, -0.8, 0.2))})
    for (const double g : {-0.8, 0.0, 0.6})
      for (int i = 0; i < 64; ++i) {
        const double u = (i + 0.5) / 64, v = (i * 37 % 64) / 64.0;
        const Vec3d turned = henyey_greenstein_direction(direction, g, u, v);
        EXPECT_NEAR(length(turned), 1, 1e-15);
        EXPECT_NEAR(dot(turned, direction), henyey_greenstein_cosine(g, u), 1e-15);
      }
}

}  // namespace
}  // namespace orrery::test
