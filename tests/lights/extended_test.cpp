#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests directional lights with an angle (suns) and line lights, with path tracing and Whitted ray tracing.
namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;

// Samples of one light's kernel for a surface point at the origin.
struct Kernel {
  std::shared_ptr<const Scene> scene;
  LightKernelPtr<double> kernel;
  SurfaceBatch<double> surface{};
  LightChoices<double> choices{};
  LightBatch<double> out{};
  RayBatch<double> rays{};
  Vec3Array<double> radiance{};
  Array<double> pdf{};
  Array<IndexOf<double>> slot{};
  LaneGroups all = LaneGroups::covering(0, kBatch, kWidth<double>);

  explicit Kernel(const Json& light)
      : scene(load(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]"),
                              Json{{"lights", Json::array({light})}}))) {
    const LightPlace& place = scene->lights.front();
    kernel = scene->light_sets[place.set]->kernel(double());
    for (int i = 0; i < kBatchRoom; ++i) {
      choices.index[i] = place.index;
      choices.probability[i] = 0.25;
      slot[i] = i % kBatch;
    }
  }
  void sample(int number) {
    const Draws draws(7, TileView{0, 0, kTileSide, kTileSide}, number);
    kernel->sample_each(surface, choices, PathDraws<double>{draws, slot, 0}, all, out);
  }
  // Computes density and radiance along the directions of `rays`.
  void look() { kernel->beyond(rays, {static_cast<int>(choices.index[0]), 0.25}, all, radiance, pdf); }
};

Json sun(double degrees, const Vec3d& from = Vec3d(1, 2, -0.5)) {
  return {{"type", "directional"}, {"direction_to_light", numbers(from)}, {"angle_degrees", degrees}};
}

// Counts samples in parts of the sun's disc with equal solid angles: rings of equal height and sectors.
TEST(Sun, SamplesDiscUniformly) {
  covers("light-24");
  constexpr int kRings = 8, kSectors = 16, kSamples = 64;
  const Vec3d axis = safe_normalize(Vec3d(1, 2, -0.5)), side = perpendicular(axis), third = cross(axis, side);
  for (const double degrees : {0.53, 20.0, 170.0}) {
    const auto kernel = std::make_unique<Kernel>(sun(degrees));
    const double height = 1 - std::cos(degrees / 2 * kPi / 180);
    std::array<int, kRings * kSectors> counts{};
    for (int sample = 0; sample < kSamples; ++sample) {
      kernel->sample(sample);
      for (int i = 0; i < kBatch; ++i) {
        const Vec3d d = kernel->out.shadow.direction[i];
        ASSERT_NEAR(length(d), 1, 1e-14);
        const Vec3d chord = d - axis;
        const double ring = dot(chord, chord) / 2 / height * kRings;
        ASSERT_LT(ring, kRings * (1 + 1e-9));
        const double turn = std::atan2(dot(d, third), dot(d, side)) / (2 * kPi) + 0.5;
        ++counts[static_cast<std::size_t>(std::min(kRings - 1, static_cast<int>(ring)) * kSectors +
                                          std::min(kSectors - 1, static_cast<int>(turn * kSectors)))];
      }
    }
    double chi2 = 0;
    const double expected = double{kBatch} * kSamples / (kRings * kSectors);
    for (const int count : counts) chi2 += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi2, 127 + 4 * std::sqrt(2 * 127.0)) << degrees;
  }
}

TEST(Sun, ReportsDensityAndRadianceOfSamples) {
  covers("light-24 light-25");
  for (const double degrees : {0.53, 20.0, 170.0}) {
    const auto kernel = std::make_unique<Kernel>(sun(degrees));
    const double half = degrees / 2 * kPi / 180;
    kernel->sample(3);
    kernel->rays.direction = kernel->out.shadow.direction;
    kernel->look();
    for (int i = 0; i < kBatch; ++i) {
      ASSERT_NEAR(kernel->pdf[i] * 2 * kPi * (1 - std::cos(half)), 0.25, 1e-9)
          << "includes the selection probability";
      ASSERT_EQ(kernel->out.pdf[i], kernel->pdf[i]);
      ASSERT_NEAR(kernel->out.incident[i].x * kPi * kernel->pdf[i] / kernel->radiance[i].x, 1, 1e-12);
      ASSERT_NEAR(kernel->radiance[i].x * std::sin(half) * std::sin(half), 1, 1e-9);
    }
    const Vec3d axis = safe_normalize(Vec3d(1, 2, -0.5)), side = perpendicular(axis);
    for (const double share : {0.999, 1.001}) {
      kernel->rays.direction.set(0, axis * std::cos(half * share) + side * std::sin(half * share));
      kernel->look();
      EXPECT_EQ(kernel->radiance[0].x > 0, share < 1) << degrees;
      EXPECT_EQ(kernel->pdf[0] > 0, share < 1) << degrees;
    }
  }
}

// The radiance of a tilted white floor under the sun is the cosine of the tilt, as under parallel light.
TEST(Sun, MatchesParallelLightOfSameIntensity) {
  covers("light-17");
  for (const double degrees : {0.0, 0.53, 10.0, 60.0})
    for (const double tilt : {0.0, 0.5}) {
      Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
                            "{'materials': {'white': {'type': 'lambert', 'kd': null, 'reflectance': 1}}}");
      scene["lights"] = Json::array({sun(degrees, Vec3d(std::sin(tilt), std::cos(tilt), 0))});
      const Estimate found = estimate(scene, Vec3d(30, 0.05, 0), Vec3d(), 1);
      EXPECT_NEAR(found.mean, std::cos(tilt), 4 * found.error() + 1e-9) << degrees << " " << tilt;
    }
}

TEST(Sun, IsVisibleToCameraAndInMirrors) {
  Json scene = scene_of(
      "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
      "{'materials': {'white': {'type': 'reflective', 'kd': null, 'n': [0.1, 0.1, 0.1], 'k': [4, 4, 4]}}}");
  scene["lights"] = Json::array({sun(10, Vec3d(0, 1, 0))});
  const double radiance = 1 / std::pow(std::sin(5 * kPi / 180), 2);
  EXPECT_NEAR(estimate(scene, Vec3d(0, 1, 0), Vec3d(0.01, 2, 0), 1).mean, radiance, 1e-6);
  EXPECT_EQ(estimate(scene, Vec3d(0, 1, 0), Vec3d(1, 2, 0), 1).mean, 0);
  const double mirrored = estimate(scene, Vec3d(0, 1, 0), Vec3d(0.01, 0, 0), 1).mean;
  EXPECT_GT(mirrored, 0.9 * radiance);
  EXPECT_LT(mirrored, radiance);
}

// Techniques other than path tracing treat the sun as parallel light.
TEST(Sun, ActsAsParallelLightInWhittedTracing) {
  Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]");
  scene["lights"] = Json::array({sun(60, Vec3d(0.6, 0.8, 0))});
  const auto answer = [&] {
    return Tracing(scene).trace({Vec3d(3, 1, 0), safe_normalize(Vec3d(-3, -1, 0))});
  };
  const Vec3d wide = answer().radiance;
  scene["lights"] = Json::array({sun(0, Vec3d(0.6, 0.8, 0))});
  EXPECT_EQ(wide, answer().radiance);
  EXPECT_NEAR(wide.x, 0.8, 1e-12);
}

Json over_floor(const Vec3d& from, const Vec3d& to) {
  Json scene = scene_of("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]}]",
                        "{'materials': {'white': {'type': 'lambert', 'kd': null, 'reflectance': 1}}}");
  scene["lights"] = Json::array(
      {{{"type", "line"}, {"from", numbers(from)}, {"to", numbers(to)}, {"intensity_per_metre", {1, 1, 1}}}});
  return scene;
}

// Returns the radiance of a white floor at `at`, with 200,000 point lights in place of the line light.
double irradiance_by_points(const Vec3d& from, const Vec3d& to, const Vec3d& at) {
  constexpr int kDots = 200'000;
  double sum = 0;
  for (int i = 0; i < kDots; ++i) {
    const Vec3d d = from + (to - from) * ((i + 0.5) / kDots) - at;
    sum += std::max(0.0, d.y) / std::pow(dot(d, d), 1.5);
  }
  return sum * length(to - from) / kDots / kPi;
}

TEST(Line, MatchesIrradianceOfPointLights) {
  covers("R11 light-17");
  const Estimate middle =
      estimate(over_floor(Vec3d(-1, 1, 0), Vec3d(1, 1, 0)), Vec3d(0, 0.05, 30), Vec3d(), 1);
  EXPECT_NEAR(middle.mean, std::numbers::sqrt2 / kPi, 4 * middle.error());
  EXPECT_LT(middle.sd / middle.mean, 0.15) << "only the cosine at the floor causes noise";
  const Estimate endless =
      estimate(over_floor(Vec3d(-1e5, 1, 0), Vec3d(1e5, 1, 0)), Vec3d(0, 0.05, 30), Vec3d(), 1);
  EXPECT_NEAR(endless.mean, 2 / kPi, 4 * endless.error());
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Vec3d from = random.in_cube(2) + Vec3d(0, 2.5, 0), to = random.in_cube(2) + Vec3d(0, 2.5, 0);
    const Estimate found = estimate(over_floor(from, to), Vec3d(0, 0.05, 30), Vec3d(), 1);
    const double expected = irradiance_by_points(from, to, Vec3d());
    EXPECT_NEAR(found.mean, expected, 4 * found.error() + 1e-6 * expected) << i;
  }
}

// The floor point is on or near the axis of a vertical line light. On the axis, the irradiance is 1 / near -
// 1 / far, where near and far are the distances of the light's ends.
TEST(Line, StaysFiniteOnItsAxis) {
  for (const double aside : {1e-3, 1e-6, 1e-9}) {
    const Estimate found =
        estimate(over_floor(Vec3d(aside, 1, 0), Vec3d(aside, 3, 0)), Vec3d(0, 0.05, 30), Vec3d(), 1);
    EXPECT_NEAR(found.mean, (1 - 1.0 / 3) / kPi, 1e-4) << aside;
  }
  EXPECT_EQ(estimate(over_floor(Vec3d(0, 1, 0), Vec3d(0, 3, 0)), Vec3d(0, 0.05, 30), Vec3d(), 1).sd, 0)
      << "finite on the axis";
}

TEST(Line, ActsAsPointLightInWhittedTracing) {
  Json scene = over_floor(Vec3d(-1, 2, 0), Vec3d(1, 2, 0));
  scene["materials"]["white"] = {{"type", "rough"}, {"kd", 1}};
  const TraceOutput answer = Tracing(scene).trace({Vec3d(0, 0.05, 30), safe_normalize(Vec3d(0, -0.05, -30))});
  EXPECT_NEAR(answer.radiance.x, 2.0 / 4 / kPi, 1e-12);
}

TEST(Line, RejectsZeroLength) {
  EXPECT_EQ(first_problem(over_floor(Vec3d(1, 1, 1), Vec3d(1, 1, 1))), "/lights/0/to");
}

}  // namespace
}  // namespace orrery::test
