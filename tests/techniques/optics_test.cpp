#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/tracing.h"

// Compares directions of reflected and refracted rays with the laws of optics.
namespace orrery::test {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

RenderRequest depth(int max_depth) {
  RenderRequest request;
  request.max_depth = max_depth;
  return request;
}

Json one_body(const char* object, double ior) {
  Json scene = scene_of(object);
  scene["objects"][0]["material"] = "glass";
  scene["materials"]["glass"] = {{"type", "refractive"}, {"ior", ior}, {"fresnel", "exact"}};
  return scene;
}
Json unit_ball(double ior) { return one_body("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]", ior); }

constexpr const char* kMirror =
    "{'materials': {'white': {'type': 'reflective', 'kd': null, 'n': [0, 0, 0], 'k': [0, 0, 0]}}}";

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) / kRadians;
}

// Returns the rays of one depth that leave the body at the origin.
std::vector<Ray<double>> leaving(const Tracing& tracing, std::size_t depth) {
  std::vector<Ray<double>> found;
  for (const auto& ray : tracing.rays().at(depth))
    if (dot(ray.origin, ray.direction) > 0) found.push_back(ray);
  return found;
}

TEST(Slab, ShiftsRayWithoutChangingDirection) {
  covers("R18 D4");
  Tracing tracing(one_body("[{'type': 'box', 'min': [-50, -50, -0.5], 'max': [50, 50, 0.5]}]", 1.5),
                  depth(2));
  for (const double degrees : {10.0, 30.0, 60.0, 80.0}) {
    const double sine = std::sin(degrees * kRadians), cosine = std::cos(degrees * kRadians);
    const Ray<double> in{Vec3d(0, 0, 0.5) - Vec3d(sine, 0, -cosine) * 3, Vec3d(sine, 0, -cosine)};
    tracing.trace(in);
    Ray<double> out;
    for (const auto& ray : tracing.rays().at(2))
      if (ray.direction.z < 0) out = ray;
    EXPECT_NEAR(angle_between(out.direction, Vec3d(0, 0, -1)), degrees, 1e-10);
    EXPECT_NEAR(angle_between(out.direction, in.direction), 0, 1e-10);
    const Vec3d across = out.origin - in.origin;
    const double shift = length(across - in.direction * dot(across, in.direction));
    EXPECT_NEAR(shift, sine * (1 - cosine / std::sqrt(2.25 - sine * sine)), 1e-12);
    if (degrees == 30) {
      EXPECT_NEAR(shift, .193813782, 5e-10);
    }
  }
}

TEST(Prism, HasMinimumDeviationOnSymmetricPath) {
  covers("R19");
  // An equilateral prism along y. Its upper edge is at z = sqrt 3, its base at z = 0.
  const double edge = std::sqrt(3.0);
  Json mesh = json(
      "{'type': 'mesh', 'indices': [[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5], [0, 2, "
      "1], [3, 4, 5]]}");
  for (const double y : {-5.0, 5.0})
    for (const Vec3d& corner : {Vec3d(-1, y, 0), Vec3d(0, y, edge), Vec3d(1, y, 0)})
      mesh["positions"].push_back(numbers(corner));
  Tracing tracing(one_body(Json::array({mesh}).dump().c_str(), 1.5), depth(2));
  const auto deviation = [&](double incidence_degrees) {
    // The ray enters the left face in its middle and runs along the base. The inward normal of this face is
    // 30 degrees below +x.
    const double a = (incidence_degrees - 30) * kRadians;
    const Vec3d direction(std::cos(a), 0, std::sin(a)), middle(-0.5, 0.1, edge / 2);
    const Ray<double> in{middle - direction * 2, direction};
    tracing.trace(in);
    for (const auto& ray : tracing.rays().at(2))
      if (ray.origin.x > 0 &&
          ray.direction.x * std::cos(30 * kRadians) + ray.direction.z * std::sin(30 * kRadians) > 0)
        return angle_between(in.direction, ray.direction);
    return -1.0;
  };
  const double symmetric = std::asin(1.5 * 0.5) / kRadians;
  EXPECT_NEAR(deviation(symmetric), 37.180756, 5e-7);
  EXPECT_NEAR(deviation(symmetric), 2 * symmetric - 60, 1e-9);
  EXPECT_GT(deviation(symmetric + 2), deviation(symmetric));
  EXPECT_GT(deviation(symmetric - 2), deviation(symmetric));
}

TEST(WaterDrop, MatchesRainbowAngle) {
  covers("R20");
  Tracing tracing(unit_ball(1.333), depth(3));
  const auto deviation = [&](double h) {  // with one internal reflection
    const Ray<double> in{{h, 0, 5}, {0, 0, -1}};
    tracing.trace(in);
    const auto out = leaving(tracing, 3);
    return out.size() == 1 ? angle_between(in.direction, out.front().direction) : -1.0;
  };
  const double cosine2 = (1.333 * 1.333 - 1) / 3, rainbow = std::sqrt(1 - cosine2);
  EXPECT_NEAR(deviation(rainbow), 137.92189, 5e-6);
  EXPECT_GT(deviation(rainbow + 0.01), deviation(rainbow));
  EXPECT_GT(deviation(rainbow - 0.01), deviation(rainbow));
}

TEST(BallLens, MatchesAxisCrossings) {
  covers("R21");
  Tracing tracing(unit_ball(1.5), depth(2));
  const auto crossing = [&](double h) {
    tracing.trace(Ray<double>{{h, 0, 5}, {0, 0, -1}});
    const auto out = leaving(tracing, 2);
    return out.size() == 1 ? -(out[0].origin.z - out[0].origin.x * out[0].direction.z / out[0].direction.x)
                           : -1.0;
  };
  EXPECT_NEAR(crossing(1e-5), 1.5, 1e-9);
  EXPECT_NEAR(crossing(.5), 1.3915729, 5e-8);
  EXPECT_NEAR(crossing(.75), 1.2410406, 5e-8);
  EXPECT_NEAR(crossing(.9), 1.1044456, 5e-8);
}

TEST(ConcaveMirror, MatchesAxisCrossings) {
  covers("R22");
  Tracing tracing(scene_of("[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}]", kMirror), depth(1));
  for (const double h : {1e-6, .1, .5, .75, .9}) {
    tracing.trace(Ray<double>{{h, 0, 0}, {0, 0, 1}});
    ASSERT_EQ(tracing.rays().at(1).size(), 1u);
    const Ray<double> back = tracing.rays()[1][0];
    const double crossing = back.origin.z - back.origin.x * back.direction.z / back.direction.x;
    EXPECT_NEAR(crossing, 1 / (2 * std::cos(std::asin(h))), 1e-9) << h;
  }
}

TEST(CornerReflector, ReversesEveryRay) {
  covers("R23");
  Tracing tracing(scene_of(R"([{'type': 'plane', 'point': [0, 0, 0], 'normal': [1, 0, 0]},
                               {'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 1, 0]},
                               {'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}])",
                           kMirror),
                  depth(5));
  Random random(1);
  for (int i = 0; i < 2'000; ++i) {
    const Vec3d direction =
        safe_normalize(Vec3d(-random.between(0.1, 1), -random.between(0.1, 1), -random.between(0.1, 1)));
    tracing.trace(Ray<double>{{random.between(1, 2), random.between(1, 2), random.between(1, 2)}, direction});
    ASSERT_EQ(tracing.rays().size(), 4u);
    EXPECT_LE(max_component(abs(tracing.rays()[3][0].direction + direction)), 1e-14);
  }
}

// From under water, the whole sky is visible within 48.6 degrees of the vertical.
TEST(WaterSurface, ShowsSkyInSnellsWindow) {
  covers("R25");
  Json scene = one_body("[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]", 1.333);
  scene["materials"]["black"] = {{"type", "rough"}, {"kd", 0}};
  scene["objects"].push_back(
      json("{'type': 'plane', 'point': [0, 0, -10], 'normal': [0, 0, 1], 'material': 'black'}"));
  scene["background"] = {1, 1, 1};
  Tracing tracing(scene, depth(4));
  const auto sky = [&](double degrees) {
    return tracing
        .trace(Ray<double>{{0, 0, -1}, {std::sin(degrees * kRadians), 0, std::cos(degrees * kRadians)}})
        .radiance.x;
  };
  double lowest = 20, highest = 80;
  for (int i = 0; i < 50; ++i) {
    const double middle = (lowest + highest) / 2;
    (sky(middle) > 0 ? lowest : highest) = middle;
  }
  EXPECT_NEAR(lowest, 48.606626, 5e-7);
  EXPECT_NEAR(sky(0), 1 - std::pow(.333 / 2.333, 2), 1e-12);
  EXPECT_NEAR(std::pow(std::sin(lowest * kRadians), 2), .562781, 5e-7)
      << "fraction of the cosine-weighted hemisphere";
}

}  // namespace
}  // namespace orrery::test
