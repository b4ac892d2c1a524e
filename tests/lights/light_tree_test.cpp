#include "core/lighting/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/lighting/power_heuristic.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests light selection at surface points.
namespace orrery::test {
namespace {

LightBounds small_light(Random& random) {
  return {.centre = random.in_cube(1), .strength = random.between(1, 3), .attenuation = {0, 0, 1}};
}

// Returns the bounds of a random flat or round lamp, point light with or without attenuation, or sun.
LightBounds any_light(Random& random) {
  LightBounds light = small_light(random);
  switch (random.below(5)) {
    case 0: light.normal = safe_normalize(random.in_cube(1)); [[fallthrough]];
    case 1:
      light.radius = random.between(0.001, 0.2);
      light.attenuation = {1, 0, 2 / (light.radius * light.radius)};
      break;
    case 2: light.attenuation = {1, 0.5, 0.25}; break;
    case 3: light.parallel = true; [[fallthrough]];
    default: light.attenuation = {1, 0, 0};
  }
  return light;
}

template <class Make>
std::vector<LightBounds> lights_of(int count, Make make) {
  Random random(11);
  std::vector<LightBounds> lights;
  for (int i = 0; i < count; ++i) lights.push_back(make(random));
  return lights;
}

struct SelectedLight {
  std::size_t light;
  double probability;
};
template <class T>
SelectedLight choose(const LightTree<T>& tree, const Vec3<T>& at, double u) {
  using N = Lanes<T>;
  std::array<double, LightTree<T>::kPoints> numbers;
  numbers.fill(u);
  const auto choices = tree.choose({N(at.x), N(at.y), N(at.z)}, numbers);
  return {choices.light.back(), choices.probability.back()};
}

constexpr int kCounts[] = {1, 2, 5, 16, 17, 33, 300, 5000};

// For every light, the sum of 1 / probability over its draws, divided by the number of all draws, has mean 1.
TEST(LightTree, InverseProbabilityWeightingIsUnbiased) {
  covers("light-23");
  constexpr int kDraws = 10000;
  const auto lights = lights_of(33, small_light);
  const LightTree<double> tree(lights);
  Random random(3);
  for (const Vec3d& at : {Vec3d(2, 3, -1), Vec3d(0.1, 2.2, 0.3), Vec3d(-4, 0, 1)}) {
    std::vector<double> sums(33);
    for (int i = 0; i < kDraws; ++i) {
      const auto [light, probability] = choose(tree, at, (i + random.unit()) / kDraws);
      sums[light] += 1 / probability / kDraws;
    }
    for (const double sum : sums) EXPECT_NEAR(sum, 1, 0.02);
  }
}

TEST(LightTree, SelectsByPowerAtLargeDistance) {
  covers("light-23");
  const auto lights = lights_of(33, small_light);
  const LightTree<double> tree(lights);
  double power = 0;
  for (const LightBounds& light : lights) power += light.strength;
  for (std::size_t i = 0; i < 33; ++i)
    EXPECT_NEAR(tree.probability(Vec3d(300, 500, -200), i) / (lights[i].strength / power), 1, 0.03);
}

template <class T>
void tells_the_probability(int count) {
  const LightTree<T> tree(lights_of(count, any_light));
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3<T> at(random.in_cube(1) * random.between(0.01, 4));
    const auto [light, probability] = choose(tree, at, random.unit());
    ASSERT_LT(light, static_cast<std::size_t>(count));
    EXPECT_GT(probability, 0);
    EXPECT_EQ(probability, double{tree.probability(at, light)});
  }
}
TEST(LightTree, ReportsProbabilityOfSelection) {
  covers("light-23");
  for (const int count : kCounts) {
    tells_the_probability<double>(count);
    tells_the_probability<float>(count);
  }
}

TEST(LightTree, GivesEveryLightPositiveProbability) {
  covers("light-25");
  Random random(7);
  for (const int count : kCounts) {
    const LightTree<double> tree(lights_of(count, any_light));
    for (int i = 0; i < 20; ++i) {
      const Vec3d at = random.in_cube(1) * 2.0;
      double sum = 0;
      for (std::size_t light = 0; light < tree.size(); ++light) {
        const double probability = tree.probability(at, light);
        EXPECT_GT(probability, 0);
        sum += probability;
      }
      EXPECT_NEAR(sum, 1, 1e-12) << count;
    }
  }
}

TEST(LightTree, SamplesInProportionToProbability) {
  covers("light-24");
  constexpr int kDraws = 200000;
  const auto lights = lights_of(101, any_light);
  const LightTree<float> tree(lights);
  Random random(9);
  for (int turn = 0; turn < 5; ++turn) {
    const Vec3f at(random.in_cube(1));
    std::vector<int> counts(101);
    for (int i = 0; i < kDraws; ++i) ++counts[choose(tree, at, random.unit()).light];
    double chi2 = 0, rare = 0, rare_count = 0;
    int bins = 0;
    for (std::size_t i = 0; i < 101; ++i) {
      const double expected = kDraws * double{tree.probability(at, i)};
      if (expected < 5) {
        rare += expected;
        rare_count += counts[i];
        continue;
      }
      chi2 += (counts[i] - expected) * (counts[i] - expected) / expected;
      ++bins;
    }
    EXPECT_LE(std::abs(rare - rare_count), 5 * std::sqrt(rare) + 1);
    EXPECT_LT(chi2, bins + 4 * std::sqrt(2.0 * bins));
  }
}

// The MIS weight of a light that a BSDF sample hits uses the probability with which the tree selects this
// light.
TEST(LightTree, SumsMisWeightsToOne) {
  covers("light-21");
  const LightTree<double> tree(lights_of(33, any_light));
  Random random(13);
  for (int i = 0; i < 1000000; ++i) {
    const Vec3d at = random.in_cube(1) * 3.0;
    const auto [light, probability] = choose(tree, at, random.unit());
    const double by_angle = std::exp2(random.between(-20, 20)), by_lobe = std::exp2(random.between(-20, 20));
    ASSERT_NEAR(power_heuristic(probability * by_angle, by_lobe) +
                    power_heuristic(by_lobe, tree.probability(at, light) * by_angle),
                1, 1e-14);
  }
}

// A narrow sun has a density whose square overflows a float.
TEST(PowerHeuristic, HandlesDensitiesWithOverflowingSquares) {
  EXPECT_EQ(power_heuristic(1e30f, 1.0f), 1.0f);
  EXPECT_EQ(power_heuristic(1.0f, 1e30f), 0.0f);
  EXPECT_EQ(power_heuristic(1e30f, 1e30f), 0.5f);
  EXPECT_EQ(power_heuristic(1e-30f, 1e-30f), 0.5f);
}

// Selection does not depend on the unit of length.
TEST(LightTree, IsScaleInvariant) {
  const auto lights = lights_of(300, any_light);
  const LightTree<float> tree(lights);
  for (const double scale : {0x1p17, 0x1p-17}) {
    auto scaled = lights;
    for (LightBounds& light : scaled) {
      light.centre = light.centre * scale;
      light.radius *= scale;
      light.attenuation.y /= scale;
      light.attenuation.z /= scale * scale;
    }
    const LightTree<float> other(scaled);
    Random random(17);
    for (int i = 0; i < 1000; ++i) {
      const Vec3f at(random.in_cube(1));
      const double u = random.unit();
      const SelectedLight one = choose(tree, at, u), two = choose(other, at * static_cast<float>(scale), u);
      EXPECT_EQ(one.light, two.light);
      EXPECT_EQ(one.probability, two.probability);
    }
  }
}

// The probabilities of 100 coincident lights sum to 1, even if the lights have zero strength or the surface
// point is at their centre.
TEST(LightTree, SelectsAmongCoincidentLights) {
  for (const double strength : {0.0, 1.0}) {
    const LightTree<double> tree(std::vector<LightBounds>(
        100, LightBounds{.centre = Vec3d(1, 2, 3), .strength = strength, .attenuation = {0, 0, 1}}));
    for (const Vec3d& at : {Vec3d(1, 2, 3), Vec3d(1, 2, 4)}) {
      double sum = 0;
      for (std::size_t i = 0; i < 100; ++i) sum += tree.probability(at, i);
      EXPECT_NEAR(sum, 1, 1e-12);
      EXPECT_LT(choose(tree, at, 0x1.fffffffffffffp-1).light, 100u);
    }
  }
}

// The radiance of the floor is the sum of (radius / distance)^2 times the cosine over emissive balls.
// Distances differ by a factor of up to 30. With 40 balls, one sample has a relative standard deviation of
// 2.67 for uniform selection, and of 0.41 for selection by distance.
TEST(LightTree, MatchesIrradianceOfNearAndFarBalls) {
  covers("light-17");
  for (const int count : {5, 40}) {
    Json scene = scene_of(
        "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
        "{'materials': {'white': {'kd': 1}, 'lamp': {'type': 'rough', 'kd': 0, 'emission': [1, 1, 1]}}}");
    double expected = 0;
    for (int i = 0; i < count; ++i) {
      const double turn = 2.4 * i, cosine = 0.3 + 0.65 * (i + 0.5) / count,
                   sine = std::sqrt(1 - cosine * cosine);
      const double distance = 1 + 29.0 * ((7 * i) % count) / count, radius = 0.1;
      expected += std::pow(radius / distance, 2) * cosine;
      const Vec3d centre = Vec3d(sine * std::cos(turn), cosine, sine * std::sin(turn)) * distance;
      scene["objects"].push_back(
          {{"type", "sphere"}, {"center", numbers(centre)}, {"radius", radius}, {"material", "lamp"}});
    }
    const Estimate found = estimate(scene, Vec3d(30, 0.05, 0), Vec3d(0), 1);
    EXPECT_NEAR(found.mean / expected, 1, 4 * found.error() / expected) << count;
    EXPECT_LT(found.sd / expected, 0.8) << count;
  }
}

}  // namespace
}  // namespace orrery::test
