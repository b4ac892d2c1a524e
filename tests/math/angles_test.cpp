#include "core/math/angles.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"

namespace orrery {
namespace {

constexpr long double kRadians = std::numbers::pi_v<long double> / 180;

TEST(Angles, ComputesSineAndCosineWithinOneUlp) {
  test::Random random(1);
  for (int i = 0; i < 200'000; ++i) {
    const double degrees = random.between(-720, 720);
    const long double radians = std::remainder(static_cast<long double>(degrees), 360.0L) * kRadians;
    const SineCosine a = sine_cosine_degrees(degrees);
    EXPECT_NEAR(static_cast<double>(static_cast<long double>(a.sine) - std::sin(radians)), 0, 2.3e-16)
        << degrees;
    EXPECT_NEAR(static_cast<double>(static_cast<long double>(a.cosine) - std::cos(radians)), 0, 2.3e-16)
        << degrees;
  }
}

TEST(Angles, IsExactAtQuarterTurns) {
  for (int turns = -9; turns <= 9; ++turns) {
    const SineCosine a = sine_cosine_degrees(90.0 * turns);
    const int quarter = ((turns % 4) + 4) % 4;
    EXPECT_EQ(a.sine, quarter == 1 ? 1 : quarter == 3 ? -1 : 0) << turns;
    EXPECT_EQ(a.cosine, quarter == 0 ? 1 : quarter == 2 ? -1 : 0) << turns;
  }
  EXPECT_NEAR(sine_cosine_degrees(30).sine, 0.5, 1e-16);
  EXPECT_NEAR(tangent_degrees(45), 1, 2.3e-16);
  EXPECT_EQ(tangent_degrees(0), 0);
}

TEST(Angles, IsPeriodicBitwise) {
  test::covers("E10");
  test::Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    const double degrees = std::floor(random.between(-180, 180) * 1024) / 1024;  // sums with 360 k are exact
    const double far = degrees + 360.0 * random.below(1'000'000);
    EXPECT_EQ(sine_cosine_degrees(far).sine, sine_cosine_degrees(degrees).sine) << far;
    EXPECT_EQ(sine_cosine_degrees(far).cosine, sine_cosine_degrees(degrees).cosine) << far;
  }
}

TEST(Angles, MirrorsOppositeAngles) {
  test::Random random(3);
  for (int i = 0; i < 10'000; ++i) {
    const double degrees = random.between(0, 180);
    const SineCosine a = sine_cosine_degrees(degrees), b = sine_cosine_degrees(-degrees);
    EXPECT_EQ(a.sine, -b.sine);
    EXPECT_EQ(a.cosine, b.cosine);
  }
}

}  // namespace
}  // namespace orrery
