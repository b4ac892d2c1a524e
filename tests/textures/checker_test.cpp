#include "core/textures/checker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"

namespace orrery::test {
namespace {

constexpr Checker<double> kBlackAndWhite{Vec3d(1), Vec3d(0)};

TEST(Checker, AlternatesBetweenCells) {
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -3; z <= 3; ++z) {
        const double even = (x + y + z) % 2 == 0 ? 1 : 0;
        EXPECT_EQ(kBlackAndWhite.value({x + 0.5, y + 0.25, z + 0.75}, Vec3d(0)), Vec3d(even));
      }
}

// Compares with the overlap of the interval and each cell.
TEST(Checker, AveragesIntervalsExactly) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.between(-20, 20), width = random.magnitude(1e-6, 30);
    const double from = x - width / 2, to = x + width / 2;
    double sum = 0;
    for (double cell = std::floor(from); cell < to; ++cell) {
      const double overlap = std::min(to, cell + 1) - std::max(from, cell);
      sum += (std::fmod(std::abs(cell), 2) == 0 ? 1 : -1) * overlap;
    }
    EXPECT_NEAR(Checker<double>::mean_sign(x, width), sum / width, 1e-13 / std::min(1.0, width)) << x;
  }
}

TEST(Checker, AveragesBoxesLikeASumOverPoints) {
  Random random(2);
  constexpr int kSteps = 48;
  for (int i = 0; i < 20; ++i) {
    const Vec3d at(random.between(-5, 5), random.between(-5, 5), random.between(-5, 5));
    const Vec3d width(random.between(0, 3), random.between(0, 3), random.between(0, 3));
    double sum = 0;
    for (int a = 0; a < kSteps; ++a)
      for (int b = 0; b < kSteps; ++b)
        for (int c = 0; c < kSteps; ++c) {
          const Vec3d share((a + 0.5) / kSteps - 0.5, (b + 0.5) / kSteps - 0.5, (c + 0.5) / kSteps - 0.5);
          sum += kBlackAndWhite.value(at + width * share, Vec3d(0)).x;
        }
    EXPECT_NEAR(kBlackAndWhite.value(at, width).x, sum / (kSteps * kSteps * kSteps), 0.03);
  }
}

TEST(Checker, TendsToTheMeanOfBothColours) {
  EXPECT_NEAR(kBlackAndWhite.value({1e6 + 0.3, 0.2, 0.2}, {1e4, 0, 0}).x, 0.5, 1e-4);
  EXPECT_NEAR(kBlackAndWhite.value({0.3, 0.2, 0.2}, Vec3d(kMaxTextureWidth)).x, 0.5, 1e-4);
}

TEST(Checker, StaysBetweenItsColoursInFloat) {
  Random random(3);
  const Checker<float> checker{Vec3f(0.25f), Vec3f(0.75f)};
  for (int i = 0; i < 10'000; ++i) {
    const float x = static_cast<float>(random.between(-1, 1) * random.magnitude(1e-3, 1e9));
    const float width = static_cast<float>(random.magnitude(1e-9, 6e4));
    const float value = checker.value({x, 0.5f, 0.5f}, {width, 0, 0}).x;
    EXPECT_GE(value, 0.25f);
    EXPECT_LE(value, 0.75f);
  }
}

TEST(Checker, HasEqualBitsInLanesAndScalars) {
  Random random(4);
  using N = Lanes<float>;
  const Checker<float> scalar{Vec3f(0.9f, 0.1f, 0.4f), Vec3f(0.2f, 0.3f, 0.7f)};
  const auto lanes = broadcast_record<Checker, float>(scalar);
  for (int i = 0; i < 200; ++i) {
    Vec3<N> at, width;
    for (std::size_t lane = 0; lane < N::size(); ++lane)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis][lane] = static_cast<float>(random.between(-9, 9));
        width[axis][lane] = static_cast<float>(random.unit() < 0.5 ? 0 : random.magnitude(1e-4, 10));
      }
    const Vec3<N> all = lanes.value(at, width);
    for (std::size_t lane = 0; lane < N::size(); ++lane)
      EXPECT_EQ(
          Vec3f(all.x[lane], all.y[lane], all.z[lane]),
          scalar.value({at.x[lane], at.y[lane], at.z[lane]}, {width.x[lane], width.y[lane], width.z[lane]}));
  }
}

}  // namespace
}  // namespace orrery::test
