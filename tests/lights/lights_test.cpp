#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/lights/directional.h"
#include "core/lights/registry.h"
#include "tests/support/covers.h"
#include "tests/support/lights.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Json point_light(const Vec3d& attenuation) {
  return {{"type", "point"}, {"position", {0, 0, 0}}, {"attenuation", numbers(attenuation)}};
}
double weakened(const Vec3d& attenuation, double distance) {
  return arrival<double>(point_light(attenuation), Vec3d(distance, 0, 0)).incident.x;
}
std::string problem(const Json& light) {
  return first_problem(scene_with(json("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]"),
                                  Json{{"lights", Json::array({light})}}));
}

// An unnormalized direction (1, 1, 1) would light a surface with a cosine of up to 1.732.
TEST(Directional, NormalizesDirection) {
  covers("B2");
  for (const double length : {1e-150, 1e-3, 1.0, 5.0, 1e12}) {
    const Json light{{"type", "directional"}, {"direction_to_light", numbers(Vec3d(1, 1, 1) * length)}};
    const auto a = arrival<double>(light, Vec3d(3, 4, 5));
    EXPECT_NEAR(a.direction.y, 0.5773502691896258, 1e-15) << length;
    EXPECT_NEAR(dot(a.direction, a.direction), 1, 4e-16);
    EXPECT_EQ(a.t_max, kInfinity);
    EXPECT_EQ(a.incident, Vec3d(1));
  }
}

TEST(Attenuation, ClampsFormulaToOne) {
  covers("B9");
  EXPECT_NEAR(weakened(Vec3d(.25, .1, .01), 10), 0.4444444444444444, 1e-15);
  EXPECT_EQ(weakened(Vec3d(1, 0, 0), 1e9), 1);
  EXPECT_EQ(weakened(Vec3d(0, 0, 1), 4), 1.0 / 16);
  EXPECT_EQ(weakened(Vec3d(0, 1, 0), 0.5), 1) << "attenuation never amplifies";
}

TEST(Attenuation, FollowsInverseSquareWithoutClamp) {
  for (const char* type : {"point", "spot"}) {
    Json light = point_light(Vec3d(0, 0, 1));
    light["type"] = type;
    light["clamp_to_one"] = false;
    if (light["type"] == "spot") light["direction"] = {1, 0, 0};
    const auto read = [&](double distance) {
      return arrival<double>(light, Vec3d(distance, 0, 0)).incident.x;
    };
    EXPECT_NEAR(read(2), 0.25, 1e-15);
    EXPECT_NEAR(read(0.1), 100, 1e-12);
    EXPECT_NEAR(read(1e-4), 1e8, 1e-4);
    for (const float distance : {1e-3f, 1e-10f, 1e-30f}) {
      const float single = arrival<float>(light, Vec3f(distance, 0, 0)).incident.x;
      EXPECT_TRUE(single >= 1e5f && single <= 1e12f) << single << " at " << distance;
    }
    light["clamp_to_one"] = true;
    EXPECT_EQ(read(0.1), 1);
  }
}

TEST(Attenuation, StaysInUnitIntervalAtAnyDistance) {
  covers("B9 B10");
  for (const Vec3d& c : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1), Vec3d(0, 0, 1e12),
                         Vec3d(.25, .1, .01), Vec3d(1e-300, 0, 0)})
    for (const double distance : {1e-300, 1e-30, 1e-4, 1.0, 1e4, 1e154, 1e300}) {
      const double f = weakened(c, distance);
      EXPECT_TRUE(f >= 0 && f <= 1) << f << " at " << distance;
      const float single =
          arrival<float>(point_light(c), Vec3f(static_cast<float>(std::min(distance, 1e30)), 0, 0))
              .incident.x;
      EXPECT_TRUE(single >= 0 && single <= 1) << single << " at " << distance;
    }
}

TEST(Attenuation, SendsNoLightAtZeroDistance) {
  covers("B10");
  EXPECT_EQ(arrival<double>(point_light(Vec3d(0, 0, 1)), Vec3d()).t_max, -1);
  EXPECT_EQ(arrival<float>(point_light(Vec3d(1, 0, 0)), Vec3f()).t_max, -1);
  EXPECT_EQ(weakened(Vec3d(0, 0, 1), 1e-4), 1);
}

TEST(Attenuation, RejectsInvalidCoefficients) {
  covers("B9");
  EXPECT_EQ(problem(point_light(Vec3d(0, 0, 0))), "/lights/0/attenuation");
  EXPECT_EQ(problem(point_light(Vec3d(1, -2, 1))), "/lights/0/attenuation/1");
  EXPECT_EQ(problem(point_light(Vec3d(1, -.5, 0))), "/lights/0/attenuation/1");
}

Json spot(double inner, double outer) {
  return {{"type", "spot"},
          {"position", {0, 0, 0}},
          {"direction", {0, 0, -7}},
          {"inner_degrees", inner},
          {"outer_degrees", outer}};
}
IncidentLight<double> in_beam(const Json& light, double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return arrival<double>(light, Vec3d(std::sin(a), 0, -std::cos(a)) * 3);
}

TEST(Spot, FallsOffBetweenInnerAndOuterAngle) {
  covers("B14");
  const Json light = spot(20, 40);
  EXPECT_EQ(in_beam(light, 0).incident.x, 1);
  EXPECT_EQ(in_beam(light, 19.999).incident.x, 1);
  EXPECT_EQ(in_beam(light, 40.001).t_max, -1);
  EXPECT_EQ(in_beam(light, 180).t_max, -1);
  const double middle = (std::cos(20 * std::numbers::pi / 180) + std::cos(40 * std::numbers::pi / 180)) / 2;
  EXPECT_NEAR(in_beam(light, std::acos(middle) * 180 / std::numbers::pi).incident.x, 0.5, 1e-12);
  double last = 1;
  for (double degrees = 20; degrees < 40; degrees += 0.1) {
    const double now = in_beam(light, degrees).incident.x;
    EXPECT_LE(now, last);
    last = now;
  }
}

TEST(Spot, CutsOffSharplyAtEqualAngles) {
  covers("B14");
  EXPECT_EQ(in_beam(spot(30, 30), 29.99).incident.x, 1);
  EXPECT_EQ(in_beam(spot(30, 30), 30.01).t_max, -1);
  EXPECT_EQ(in_beam(spot(0, 0), 0.01).t_max, -1);
  EXPECT_EQ(in_beam(spot(0, 0), 0).incident.x, 1);
  EXPECT_EQ(in_beam(spot(180, 180), 180).incident.x, 1) << "a spot of 180 degrees is a point light";
  EXPECT_EQ(in_beam(spot(180, 180), 90).incident.x, 1);
  EXPECT_EQ(problem(spot(31, 30)), "/lights/0/inner_degrees");
}

TEST(Spot, IgnoresLengthOfDirection) {
  covers("B14");
  Json light = spot(20, 40);
  light["direction"] = {0, 0, -1e-9};
  for (const double degrees : {0.0, 25.0, 35.0})
    EXPECT_EQ(in_beam(light, degrees).incident.x, in_beam(spot(20, 40), degrees).incident.x);
}

TEST(Directional, IsParallelBelowAngularResolution) {
  const auto sun = [](float height) { return Directional<float>{Vec3f(0, 1, 0), Vec3f(1), height}; };
  EXPECT_FALSE(sun(1e-20f).extended());
  EXPECT_FALSE(sun(0).extended());
  EXPECT_TRUE(sun(1e-5f).extended());
}

// Checks every registered light type: unit directions, no light below 0 or above its intensity, and float
// close to double.
TEST(AllLights, SendsUnitDirectionsWithinIntensity) {
  const std::vector<Json> lights = {
      json("{'type': 'directional', 'direction_to_light': [1, 2, 3], 'intensity': [1, 2, 3]}"),
      json(
          "{'type': 'point', 'position': [1, 2, 3], 'intensity': [1, 2, 3], 'attenuation': [0.5, 0.1, 0.1]}"),
      json("{'type': 'spot', 'position': [1, 2, 3], 'direction': [-1, -2, -3], 'intensity': [1, 2, 3]}"),
      json("{'type': 'line', 'from': [8, 9, 8], 'to': [9, 9, 8], 'intensity_per_metre': [1, 2, 3]}")};
  ASSERT_EQ(lights.size(), light_types().size()) << "this test lacks a light type";
  Random random(1);
  for (const Json& light : lights)
    for (int i = 0; i < 300; ++i) {
      const Vec3d at = random.in_cube(4);
      const auto d = arrival<double>(light, at);
      const auto f = arrival<float>(light, Vec3f(at));
      if (d.t_max < 0) continue;
      EXPECT_NEAR(length(d.direction), 1, 4e-16) << light;
      EXPECT_TRUE(d.incident.x >= 0 && d.incident.x <= 1 && d.incident.z <= 3) << light;
      EXPECT_NEAR(d.incident.y, 2 * d.incident.x, 1e-15) << light;
      EXPECT_NEAR(static_cast<double>(f.incident.x), d.incident.x, 1e-5) << light;
      EXPECT_NEAR(static_cast<double>(f.direction.x), d.direction.x, 1e-5) << light;
    }
}

}  // namespace
}  // namespace orrery::test
