#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/textures/gradient_noise.h"
#include "core/textures/waves.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

Vec3d point(Random& random, double most) {
  return {random.between(-most, most), random.between(-most, most), random.between(-most, most)};
}

TEST(GradientNoise, IsZeroAtLatticePoints) {
  const GradientNoise<double> noise(0);
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = 250; z <= 258; ++z) EXPECT_EQ(noise.at(Vec3d(x, y, z)), 0);
}

TEST(GradientNoise, HasPeriod256) {
  const GradientNoise<double> noise(3);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p(random.between(-4, 4), random.between(-4, 4), random.between(-4, 4));
    const double here = noise.at(p);
    for (const Vec3d& period : {Vec3d(256, 0, 0), Vec3d(0, -256, 0), Vec3d(0, 0, 512)})
      EXPECT_NEAR(noise.at(p + period), here, 1e-11);
  }
}

// Divides the differences of values and of slopes on both sides of a cell face by the distance. If the second
// derivative jumped, they would tend to a constant.
TEST(GradientNoise, HasTwoContinuousDerivativesAtCellFaces) {
  const GradientNoise<double> noise(5);
  Random random(2);
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 500; ++i) {
    Vec3d p = point(random, 20);
    const auto axis = static_cast<std::size_t>(i % 3);
    p[axis] = std::round(p[axis]);
    const auto at = [&](double offset) {
      Vec3d moved = p;
      moved[axis] += offset;
      return noise.at(moved);
    };
    const double left = (at(0) - 2 * at(-kStep) + at(-2 * kStep)) / (kStep * kStep);
    const double right = (at(2 * kStep) - 2 * at(kStep) + at(0)) / (kStep * kStep);
    EXPECT_NEAR(left, right, 200 * kStep) << p.x << " " << p.y << " " << p.z;
    EXPECT_NEAR((at(kStep) - at(0)) / kStep, (at(0) - at(-kStep)) / kStep, 20 * kStep);
  }
}

TEST(GradientNoise, StaysInItsRangeWithTheStatedMeans) {
  const GradientNoise<double> noise(7);
  Random random(3);
  constexpr int kCount = 400'000;
  double most = 0, sum = 0, sum_absolute = 0;
  for (int i = 0; i < kCount; ++i) {
    const double value = noise.at(point(random, 128));
    most = std::max(most, std::abs(value));
    sum += value;
    sum_absolute += std::abs(value);
  }
  EXPECT_LE(most, GradientNoise<double>::kMax);
  EXPECT_GT(most, 0.85);
  EXPECT_NEAR(sum / kCount, 0, 0.002);
  EXPECT_NEAR(sum_absolute / kCount, NoiseSum<double>::kMeanAbsolute, 0.002);
}

// The largest value of a cell of gradient noise is at a corner of the cube of blends that depends on the
// gradients. Climbs from many starts over the least favourable gradients of all eight corners.
TEST(GradientNoise, StatesTheLargestValueOfAnyGradients) {
  const double gradients[12][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                   {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1}};
  const auto most_at = [&](const Vec3d& t) {
    const auto fade = [](double x) { return x * x * x * (x * (x * 6 - 15) + 10); };
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const double i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
      const double weight =
          (i ? fade(t.x) : 1 - fade(t.x)) * (j ? fade(t.y) : 1 - fade(t.y)) * (k ? fade(t.z) : 1 - fade(t.z));
      double most = 0;
      for (const auto& g : gradients)
        most = std::max(most, g[0] * (t.x - i) + g[1] * (t.y - j) + g[2] * (t.z - k));
      sum += weight * most;
    }
    return sum;
  };
  double most = 0;
  constexpr int kSteps = 100;
  for (int a = 0; a <= kSteps; ++a)
    for (int b = 0; b <= kSteps; ++b)
      for (int c = 0; c <= kSteps; ++c) most = std::max(most, most_at(Vec3d(a, b, c) / kSteps));
  EXPECT_NEAR(most, GradientNoise<double>::kMax, 5e-4);
}

TEST(GradientNoise, SelectsTheSameGradientsInFloatAndDouble) {
  Random random(4);
  double worst = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d p = point(random, 100);
    const Vec3f rounded(p);
    const double exact = GradientNoise<double>(9).at(Vec3d(rounded));
    worst = std::max(worst, std::abs(exact - double{GradientNoise<float>(9).at(rounded)}));
  }
  EXPECT_LT(worst, 3e-6);
}

TEST(GradientNoise, HasEqualBitsInLanesAndScalars) {
  Random random(5);
  using N = Lanes<float>;
  for (int i = 0; i < 200; ++i) {
    Vec3<N> p;
    for (std::size_t lane = 0; lane < N::size(); ++lane)
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis][lane] = static_cast<float>(random.between(-300, 300));
    const N all = GradientNoise<N>(N(11)).at(p);
    for (std::size_t lane = 0; lane < N::size(); ++lane)
      EXPECT_EQ(all[lane], GradientNoise<float>(11).at({p.x[lane], p.y[lane], p.z[lane]}));
  }
}

TEST(GradientNoise, DependsOnTheSeed) {
  int equal = 0;
  for (int seed = 1; seed < 100; ++seed)
    equal += GradientNoise<double>(seed).at({0.3, 0.6, 0.2}) == GradientNoise<double>(0).at({0.3, 0.6, 0.2});
  EXPECT_LT(equal, 5);
}

// All 12 gradients occur with the frequencies of Perlin's 16 values: 8 once, 4 twice.
TEST(GradientNoise, UsesAllGradients) {
  const GradientNoise<double> noise(0);
  std::map<std::array<int, 3>, int> counts;
  constexpr double kNear = 1e-6;  // near a lattice point the noise is the product with its gradient
  int all = 0;
  for (int x = 0; x < 24; ++x)
    for (int y = 0; y < 24; ++y)
      for (int z = 0; z < 24; ++z, ++all) {
        const auto slope = [&](const Vec3d& along) {
          return static_cast<int>(std::lround(noise.at(Vec3d(x, y, z) + along * kNear) / kNear));
        };
        ++counts[{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})}];
      }
  EXPECT_EQ(counts.size(), 12u);
  for (const auto& [gradient, count] : counts) {
    EXPECT_EQ(std::abs(gradient[0]) + std::abs(gradient[1]) + std::abs(gradient[2]), 2);
    EXPECT_GT(count, all / 16 * 3 / 4);
    EXPECT_LT(count, all / 8 * 5 / 4);
  }
}

TEST(NoiseSum, FadesOctavesSmallerThanAPixelToTheirMean) {
  const NoiseSum<double> sum{4, 0.5, 0, 2}, absolute{4, 0.5, 1, 2};
  EXPECT_EQ(sum.at({0.3, 0.4, 0.9}, Vec3d(1)), 0);
  EXPECT_DOUBLE_EQ(absolute.at({0.3, 0.4, 0.9}, Vec3d(1)), NoiseSum<double>::kMeanAbsolute);
  const NoiseSum<double> first{1, 0.5, 0, 2};
  EXPECT_NEAR(sum.at({0.3, 0.4, 0.9}, Vec3d(0.5)) * 1.875, first.at({0.3, 0.4, 0.9}, Vec3d(0)), 1e-15);
}

TEST(Waves, AverageCosinesExactly) {
  constexpr double kTurn = 2 * std::numbers::pi;
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.between(-50, 50), width = random.magnitude(1e-3, 20);
    const double exact =
        (std::sin(kTurn * (x + width / 2)) - std::sin(kTurn * (x - width / 2))) / (kTurn * width);
    EXPECT_NEAR(mean_cosine(x, width), exact, 1e-11 / std::min(1.0, width));
  }
  EXPECT_EQ(mean_cosine(3.0, 0.0), 1);
}

}  // namespace
}  // namespace orrery::test
