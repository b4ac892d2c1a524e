#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Tests the analytic cases with diffuse light of CIE 171:2006 (test cases to assess the accuracy of lighting
// computer programs). Expected values are computed from formulas of configuration factors (Howell, "A Catalog
// of Radiation Heat Transfer Configuration Factors"), because the report's tables have misprints. Lengths are
// in metres.
namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;

// Returns the configuration factor from a point to a parallel rectangle a x b at distance h whose corner is
// above the point (B-3).
double parallel(double a, double b, double h) {
  const double x = a / h, y = b / h, p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * kPi);
}
// Returns the configuration factor from a point to a perpendicular rectangle that extends by `a` from the
// point's plane. Its side b is in this plane, with one end at distance `c` from the point (B-4).
double perpendicular(double a, double b, double c) {
  const double x = a / b, y = c / b, r = std::sqrt(x * x + y * y);
  return (std::atan(1 / y) - y / r * std::atan(1 / r)) / (2 * kPi);
}

// Returns the radiance of a white Lambert surface at `point` under lamps of radiance 1. It equals the
// configuration factor of the lamps.
double measured(Json scene, const Vec3d& point, const Vec3d& normal, int samples = 64) {
  const Vec3d side = test::perpendicular(normal);
  constexpr double kHalf = 1e-3;  // half width of the receiver, which is too small to occlude light
  scene["objects"].push_back({{"type", "rectangle"},
                              {"corner", numbers(point - (side + cross(normal, side)) * kHalf)},
                              {"a", numbers(side * (2 * kHalf))},
                              {"b", numbers(cross(normal, side) * (2 * kHalf))},
                              {"material", "white"}});
  return estimate_alone(scene, point + normal * 0.1 + side * 0.02, point, 1, samples).mean;
}

Json rectangle(const Vec3d& corner, const Vec3d& a, const Vec3d& b, const char* material) {
  return {{"type", "rectangle"},
          {"corner", numbers(corner)},
          {"a", numbers(a)},
          {"b", numbers(b)},
          {"material", material}};
}
Json scene_of_lamp(const Vec3d& corner, const Vec3d& a, const Vec3d& b) {
  return scene_with(Json::array({rectangle(corner, a, b, "lamp")}),
                    json("{'materials': {'white': {'type': 'lambert', 'kd': null, 'reflectance': 1},"
                         " 'black': {'type': 'lambert', 'reflectance': 0},"
                         " 'lamp': {'type': 'lambert', 'reflectance': 0, 'emission': [1, 1, 1]}}}"));
}

void expect_factor(const Json& scene, const Vec3d& point, const Vec3d& normal, double expected,
                   int samples = 64) {
  EXPECT_NEAR(measured(scene, point, normal, samples), expected, 1e-3 * std::max(0.1, expected))
      << point.x << " " << point.y << " " << point.z;
}

// 5.3: a ceiling lamp of 1 m x 1 m lights a wall and the floor of a black room, 4 m wide and 3 m high.
TEST(Cie171, MatchesAreaLampOnWallAndFloor) {
  covers("R8 R9 light-40");
  const Json scene = scene_of_lamp(Vec3d(-0.5, -0.5, 3), Vec3d(1, 0, 0), Vec3d(0, 1, 0));
  const double illuminances[] = {32.68, 75.19, 81.32, 69.06, 53.40, 40.00};  // at 1000 cd/m^2
  for (int i = 0; i < 6; ++i) {
    const double below = 0.25 + 0.5 * i;
    const double factor = 2 * (perpendicular(2.5, 0.5, below) - perpendicular(1.5, 0.5, below));
    ASSERT_NEAR(1000 * kPi * factor, illuminances[i], 0.005);
    expect_factor(scene, Vec3d(2, 0, 3 - below), Vec3d(-1, 0, 0), factor);
  }
  for (const double x : {0.0, 0.5, 1.75}) {
    const double factor =
        2 * (parallel(x + 0.5, 0.5, 3) - (x > 0.5 ? 1 : -1) * parallel(std::abs(x - 0.5), 0.5, 3));
    expect_factor(scene, Vec3d(x, 0, 0), Vec3d(0, 0, 1), factor);
  }
}

// 5.6: a uniformly bright floor of 4 m x 4 m lights the wall at its edge and the ceiling 3 m above.
TEST(Cie171, MatchesBrightFloorOnWallAndCeiling) {
  covers("R8 R9 light-40");
  const Json scene = scene_of_lamp(Vec3d(0, -2, 0), Vec3d(4, 0, 0), Vec3d(0, 4, 0));
  const double wall[] = {0.35901, 0.27992, 0.21639, 0.16716, 0.12967};
  for (int i = 0; i < 5; ++i) {
    const double height = 0.75 + 0.5 * i, factor = 2 * perpendicular(4, 2, height);
    ASSERT_NEAR(factor, wall[i], 5e-6);
    expect_factor(scene, Vec3d(0, 0, height), Vec3d(1, 0, 0), factor);
  }
  const double ceiling[] = {0.26795, 0.30939, 0.33976, 0.35567};
  for (int i = 0; i < 4; ++i) {
    const double x = 0.25 + 0.5 * i, factor = 2 * (parallel(x, 2, 3) + parallel(4 - x, 2, 3));
    ASSERT_NEAR(factor, ceiling[i], 5e-6);
    expect_factor(scene, Vec3d(x, 0, 3), Vec3d(0, 0, -1), factor);
  }
}

// 5.7: like 5.6, with an upright screen next to the point, or with a horizontal screen in the room that
// occludes part of the floor.
TEST(Cie171, MatchesBrightFloorBehindScreens) {
  covers("R8 light-40");
  Json scene = scene_of_lamp(Vec3d(0, -2, 0), Vec3d(4, 0, 0), Vec3d(0, 4, 0));
  Json upright = scene, hanging = scene;
  upright["objects"].push_back(rectangle(Vec3d(1.5, -5, 0.5), Vec3d(0, 10, 0), Vec3d(0, 0, 4), "black"));
  // The screen is half as high as the point, so it occludes a floor area of twice its width and length.
  hanging["objects"].push_back(rectangle(Vec3d(1, -0.5, 1.5), Vec3d(0.75, 0, 0), Vec3d(0, 1, 0), "black"));
  const double x = 1.5 - 1e-6;
  expect_factor(upright, Vec3d(x, 0, 3), Vec3d(0, 0, -1), 2 * parallel(x, 2, 3), 256);
  const double hidden = 2 * (parallel(1.0, 1, 3) + parallel(0.5, 1, 3));
  expect_factor(hanging, Vec3d(1.5, 0, 3), Vec3d(0, 0, -1),
                2 * (parallel(1.5, 2, 3) + parallel(2.5, 2, 3)) - hidden, 256);
}

// 5.8: in a closed room of any shape and reflectance rho, the flux after k reflections is rho^k times the
// flux of the lamp.
TEST(Cie171, ConservesLightInClosedRoom) {
  covers("light-40");
  constexpr double kReflectance = 0.7, kSide = 4;
  constexpr int kDepth = 8;
  Json room =
      scene_with(json("[{'type': 'box', 'min': [0, 0, 0], 'max': [4, 4, 4]}]"),
                 json("{'lights': [{'type': 'point', 'position': [1.2, 2.5, 2.9], 'attenuation': [0, 0, 1]}],"
                      " 'materials': {'white': {'type': 'lambert', 'kd': null, 'reflectance': 0.7}}}"));
  RenderRequest request;
  request.technique = "path";
  request.max_depth = kDepth;
  request.reuse = 1;
  Random random(4);
  double sum = 0, squares = 0;
  constexpr int kBatches = 200;
  const auto loaded = load(room);
  for (int batch = 0; batch < kBatches; ++batch) {
    std::vector<Ray<double>> rays;  // towards uniform points of the walls
    for (int i = 0; i < kBatch; ++i) {
      const auto axis = static_cast<std::size_t>(i % 3);
      const double wall = i / 3 % 2 == 0 ? 0 : kSide;
      Vec3d from(random.between(0, kSide), random.between(0, kSide), random.between(0, kSide)), to;
      to[axis] = wall == 0 ? -1 : 1;
      from[axis] = kSide / 2;
      rays.push_back({from, to});
    }
    rays.resize(kBatch / 6 * 6);
    request.seed = static_cast<std::uint64_t>(batch);
    double mean = 0;
    for (const TraceOutput& answer : Tracing(loaded, request).trace(rays))
      mean += answer.radiance.x / static_cast<double>(rays.size());
    sum += mean / kBatches;
    squares += mean * mean / kBatches;
  }
  // A light of intensity 1 causes a radiance of 1 on a white surface 1 m away. Its flux is 4 pi^2.
  const double direct = 4 * kPi * kPi / (6 * kSide * kSide) / kPi;
  double expected = 0;
  for (int k = 1; k <= kDepth; ++k) expected += direct * std::pow(kReflectance, k);
  const double error = std::sqrt((squares - sum * sum) / kBatches);
  EXPECT_NEAR(sum, expected, 4 * error);
  EXPECT_LT(error, 2e-3 * expected);
}

// 5.9: a uniform sky through an open roof of 4 m x 4 m, 3 m above the floor, acts as a uniformly bright
// ceiling.
TEST(Cie171, MatchesUniformSkyThroughOpenRoof) {
  covers("R8 R9 light-40");
  Json room = scene_with(Json::array(), json("{'background': [1, 1, 1], 'materials': {'white': {'type': "
                                             "'lambert', 'kd': null, 'reflectance': 1},"
                                             " 'black': {'type': 'lambert', 'reflectance': 0}}}"));
  const Vec3d x(4, 0, 0), y(0, 4, 0), z(0, 0, 3);
  room["objects"] = {rectangle(Vec3d(0, -2, 0), x, z, "black"), rectangle(Vec3d(0, 2, 0), x, z, "black"),
                     rectangle(Vec3d(0, -2, 0), y, z, "black"), rectangle(Vec3d(4, -2, 0), y, z, "black")};
  Json closed = room;
  closed["objects"].push_back(rectangle(Vec3d(0, -2, 0), x, y, "black"));
  const double wall[] = {0.4512, 0.3590, 0.2799, 0.2164, 0.1672, 0.1297};
  for (int i = 0; i < 6; ++i) {
    const double below = 0.25 + 0.5 * i, factor = 2 * perpendicular(4, 2, below);
    ASSERT_NEAR(factor, wall[i], 5e-5);
    expect_factor(closed, Vec3d(1e-6, 0, 3 - below), Vec3d(1, 0, 0), factor, 256);
  }
  const double floor[] = {0.2680, 0.3094, 0.3398, 0.3557};
  for (int i = 0; i < 4; ++i) {
    const double at = 0.25 + 0.5 * i, factor = 2 * (parallel(at, 2, 3) + parallel(4 - at, 2, 3));
    ASSERT_NEAR(factor, floor[i], 5e-5);
    expect_factor(room, Vec3d(at, 0, 0), Vec3d(0, 0, 1), factor, 256);
  }
}

}  // namespace
}  // namespace orrery::test
