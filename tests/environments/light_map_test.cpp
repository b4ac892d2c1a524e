#include "core/environments/light_map.h"

#include <gtest/gtest.h>

#include "core/math/hemisphere.h"
#include "tests/environments/support.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

// Compares directions sampled from images with their densities.
namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;
using Weights = LightMap::Weights;

Texels spotted(int width, int height) {
  Random random(3);
  return painted(width, height, [&](int, int) {
    return Vec3d(random.unit(), random.unit(), random.unit()) * (random.unit() < 0.1 ? 30.0 : 1.0);
  });
}

// Returns a pale sky that is brightest at the horizon, with a sun of radiance `sun`, 5 degrees wide.
Texels sky_with_sun(double sun) {
  return painted(128, 64, [=](int x, int y) {
    const double height = std::cos(kPi * (y + 0.5) / 64);
    if (height < 0) return Vec3d(0.1);
    return Vec3d(x >= 40 && x < 42 && y >= 20 && y < 22 ? sun : 1 - 0.7 * height);
  });
}

double unit_of(Random& random) { return std::floor(random.unit() * 0x1p24) * 0x1p-24; }

TEST(ImportanceTable, SamplesCellsByProbability) {
  covers("light-24");
  const std::vector<float> weights{0, 1, 0, 4, 0, 0, 0, 0, 2, 2, 0.5f, 0};
  const ImportanceTable table(4, 3, weights);
  std::array<int, 12> counts{};
  Random random(1);
  constexpr int kDraws = 200'000;
  for (int i = 0; i < kDraws; ++i) {
    const auto cell = table.draw(unit_of(random), unit_of(random));
    ++counts[static_cast<std::size_t>(cell.row * 4 + cell.column)];
  }
  double sum = 0;
  for (int i = 0; i < 12; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const double p = table.probability({i % 4, i / 4});
    sum += p;
    EXPECT_NEAR(p, double{weights[place]} / 9.5, 1e-6);
    EXPECT_NEAR(counts[place], p * kDraws, 4 * std::sqrt(p * kDraws));
    if (weights[place] == 0) {
      EXPECT_EQ(counts[place], 0);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-15);
  EXPECT_TRUE(ImportanceTable(4, 3, std::vector<float>(12, 0.0f)).empty());
}

// In a cell half a texel wide, the density is bilinear, so its mean equals its value at the cell's centre.
TEST(LightMap, SamplesInProportionToDensity) {
  covers("light-24");
  constexpr int kWidth = 16, kHeight = 8, kDraws = 1'000'000;
  for (const Weights weights : {Weights::plain, Weights::compensated}) {
    const LightMap map(spotted(kWidth, kHeight), weights);
    std::vector<int> counts(4 * kWidth * kHeight);
    Random random(2);
    for (int i = 0; i < kDraws; ++i) {
      const auto place = map.draw(unit_of(random), unit_of(random), unit_of(random), unit_of(random));
      const int x = static_cast<int>(2 * place.x),
                y = std::min(2 * kHeight - 1, static_cast<int>(2 * place.y));
      ++counts[static_cast<std::size_t>(y * 2 * kWidth + x)];
    }
    double chi2 = 0, sum = 0;
    int cells = 0;
    for (int i = 0; i < 4 * kWidth * kHeight; ++i) {
      const double p = map.at((i % (2 * kWidth) + 0.5) / 2, (i / (2 * kWidth) + 0.5) / 2).by_texel / 4;
      sum += p;
      if (p == 0) {
        EXPECT_EQ(counts[static_cast<std::size_t>(i)], 0);
      }
      if (p * kDraws < 5) continue;
      const double off = counts[static_cast<std::size_t>(i)] - p * kDraws;
      chi2 += off * off / (p * kDraws);
      ++cells;
    }
    EXPECT_NEAR(sum, 1, 1e-6);
    EXPECT_LT(chi2, cells + 4 * std::sqrt(2.0 * cells));
  }
}

// Integrates over directions of the sphere, not over positions in the map.
TEST(LightMap, IntegratesDensityToOne) {
  covers("light-25");
  const LightMap map(spotted(16, 8));
  constexpr int kSteps = 2000;
  double sum = 0;
  for (int row = 0; row < kSteps; ++row)
    for (int column = 0; column < kSteps; ++column) {
      const double angle = kPi * (row + 0.5) / kSteps, turn = 2 * kPi * (column + 0.5) / kSteps;
      const double sine = std::sin(angle);
      const Vec3d direction(sine * std::cos(turn), std::cos(angle), sine * std::sin(turn));
      const auto place = map.place_of(direction);
      sum += map.at(place.x, place.y).by_texel * map.density_factor() / sine * sine;
    }
  EXPECT_NEAR(sum * 2 * kPi * kPi / (double{kSteps} * kSteps), 1, 2e-3);
}

TEST(LightMap, MapsDirectionsInvertibly) {
  const LightMap map(spotted(512, 256));
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d direction = random.direction();
    const auto back = map.direction_of(map.place_of(direction));
    ASSERT_NEAR(length(back.toward - direction), 0, 1e-14);
    ASSERT_NEAR(back.sine, std::hypot(direction.x, direction.z), 1e-14);
    const Vec3f single(direction);
    ASSERT_NEAR(length(map.direction_of(map.place_of(single)).toward - single), 0, 2e-6f);
  }
  const auto centre = map.place_of(Vec3d(0, 0, -1)), right = map.place_of(Vec3d(1, 0, 0));
  EXPECT_NEAR(centre.x, 256, 1e-12);
  EXPECT_NEAR(centre.y, 128, 1e-12);
  EXPECT_NEAR(right.x, 384, 1e-12);
  EXPECT_NEAR(map.place_of(Vec3d(0, 1, 0)).y, 0, 1e-12);
}

// All samples hit the sun. The remaining noise comes from solid angles that vary over the texel and its
// neighbours.
TEST(LightMap, HitsSingleTexelSunWithEverySample) {
  covers("light-34");
  const LightMap map(painted(512, 256, [](int x, int y) { return Vec3d(x == 100 && y == 127 ? 1000 : 0); }));
  Random random(6);
  constexpr int kDraws = 100'000;
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto place = map.draw(unit_of(random), unit_of(random), unit_of(random), unit_of(random));
    const auto value = map.at(place.x, place.y);
    const double light =
        value.radiance.x * map.direction_of(place).sine / (value.by_texel * map.density_factor());
    sum += light / kDraws;
    squares += light * light / kDraws;
  }
  const double solid_angle = 2 * kPi / 512 * (std::cos(127 * kPi / 256) - std::cos(128 * kPi / 256));
  EXPECT_NEAR(sum / (1000 * solid_angle), 1, 1e-4);
  EXPECT_LT(std::sqrt(std::max(0.0, squares - sum * sum)) / sum, 2e-4);
}

TEST(LightMap, DisablesSamplingOfUniformLight) {
  EXPECT_FALSE(LightMap(painted(64, 32, [](int, int) { return Vec3d(0.3, 0.2, 0.7); })).sampled());
  EXPECT_FALSE(LightMap(painted(64, 32, [](int, int) { return Vec3d(0); })).sampled());
  EXPECT_TRUE(LightMap(sky_with_sun(100)).sampled());
}

struct Moments {
  double mean, variance;
};
// Returns mean and variance of estimates of the irradiance of a floor, divided by pi. Each estimate combines
// one light sample and one cosine-distributed direction.
Moments floor_under(const LightMap& map, int draws) {
  Random random(7);
  double sum = 0, squares = 0;
  const auto density = [&](const LightMap::Value<double>& value, double sine) {
    return value.by_texel * map.density_factor() / sine;
  };
  for (int i = 0; i < draws; ++i) {
    double found = 0;
    const auto place = map.draw(unit_of(random), unit_of(random), unit_of(random), unit_of(random));
    const auto [toward, sine] = map.direction_of(place);
    if (toward.y > 0) {
      const auto value = map.at(place.x, place.y);
      const double a = density(value, sine), b = toward.y / kPi;
      found += value.radiance.x * toward.y / kPi / a * (a * a / (a * a + b * b));
    }
    const Vec3d lobe = cosine_direction(Vec3d(0, 1, 0), random.unit(), random.unit());
    const auto seen = map.place_of(lobe);
    const auto value = map.at(seen.x, seen.y);
    const double a = lobe.y / kPi, b = density(value, std::hypot(lobe.x, lobe.z));
    found += value.radiance.x * (a * a / (a * a + b * b));
    sum += found;
    squares += found * found;
  }
  const double mean = sum / draws;
  return {mean, squares / draws - mean * mean};
}

TEST(LightMap, CompensationReducesVarianceWithoutBias) {
  covers("light-35");
  constexpr int kDraws = 400'000;
  const Texels sky = sky_with_sun(300);
  const Moments plain = floor_under(LightMap(sky, Weights::plain), kDraws),
                compensated = floor_under(LightMap(sky), kDraws);
  EXPECT_NEAR(plain.mean, compensated.mean, 4 * std::sqrt((plain.variance + compensated.variance) / kDraws));
  EXPECT_GE(plain.variance / compensated.variance, 1.2);
}

}  // namespace
}  // namespace orrery::test
