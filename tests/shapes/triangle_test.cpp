#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/math/face_normal.h"
#include "core/stability/ball_mesh.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

namespace orrery::test {
namespace {

Json scene_of(const BallMesh& ball) {
  Json mesh{{"type", "mesh"}, {"positions", Json::array()}, {"indices", Json::array()}};
  for (const Vec3d& p : ball.positions) mesh["positions"].push_back(numbers(p));
  for (const auto& t : ball.triangles) mesh["indices"].push_back(t);
  return scene_with(mesh);
}

// Returns the number of rays from within the ball that miss all nearby triangles. Rays aim at vertices and
// edge midpoints. Each triangle around either end of the edge is tried, so a hit of any neighbour counts.
template <class T>
int leaks_of(const Vec3d& center, int rays_at_each) {
  const BallMesh mesh(2, center);
  const Target<T> shape(scene_of(mesh));
  Random random(7);
  int leaks = 0;
  for (int vertex = 0; vertex < static_cast<int>(mesh.positions.size()); ++vertex) {
    const std::vector<int> fan = mesh.around(vertex);
    Rays<T> rays;
    for (int i = 0; i < rays_at_each; ++i) rays.push_back(mesh.ray_at<T>(vertex, fan, center, random));
    for (const auto& hit : shape.closest(rays, fan)) leaks += !hit.met();
  }
  return leaks;
}

TEST(Mesh, DoesNotLeakAtEdgesAndVertices) {
  covers("A12");
  EXPECT_EQ(leaks_of<double>(Vec3d(), 1000), 0);  // 1106 vertices: 1.1 million rays
  EXPECT_EQ(leaks_of<float>(Vec3d(), 1000), 0);
}

TEST(Mesh, DoesNotLeakFarFromTheOrigin) {
  covers("A12");
  const Vec3d far(148376, 1234, -223423);
  EXPECT_EQ(leaks_of<double>(far, 1000), 0);
  EXPECT_EQ(leaks_of<float>(far, 200), 0) << "in float, triangles share the rounded vertices";
}

TEST(Triangle, SupportsPicometreSize) {
  covers("A13");
  for (double s = 9.9e-4; s > 0.9e-12; s /= 10) {
    const Json object{{"type", "triangle"}, {"vertices", {{0, 0, 0}, {s, 0, 0}, {0, s, 0}}}};
    const Json scene = scene_with(object);
    EXPECT_DOUBLE_EQ(Target<double>(scene).closest(Ray<double>{{s / 4, s / 4, 1}, {0, 0, -1}}).t, 1) << s;
    const auto q = static_cast<float>(s / 4);
    EXPECT_FLOAT_EQ(Target<float>(scene).closest(Ray<float>{{q, q, 1}, {0, 0, -1}}).t, 1) << s;
  }
}

TEST(Triangle, RejectsOrMissesZeroArea) {
  covers("A14");
  const auto problem = [](const char* vertices) {
    return first_problem(scene_with(Json{{"type", "triangle"}, {"vertices", json(vertices)}}));
  };
  EXPECT_EQ(problem("[[1, 2, 3], [1, 2, 3], [0, 5, 0]]"), "/objects/0/vertices");
  EXPECT_EQ(problem("[[0, 0, 0], [1, 1, 1], [2, 2, 2]]"), "/objects/0/vertices");
  EXPECT_EQ(problem("[[-1113.45459, -79.049614, -56.2431908], [-1113.45459, -87.0922699, -56.2431908],"
                    " [-1113.45459, -79.2090149, -56.2431908]]"),
            "/objects/0/vertices");

  // A mesh may contain degenerate triangles. A distant valid triangle keeps this mesh from being empty.
  const auto mesh = Target<double>::of_objects(
      R"([{'type': 'mesh', 'indices': [[0, 1, 2], [0, 0, 1], [3, 4, 5]],
           'positions': [[-1113.45459, -79.049614, -56.2431908], [-1113.45459, -87.0922699, -56.2431908],
                         [-1113.45459, -79.2090149, -56.2431908], [0, 1e6, 0], [1, 1e6, 0], [0, 1e6, 1]]}])");
  EXPECT_EQ(mesh.primitive_count(), 1);
  EXPECT_FALSE(mesh.closest(Ray<double>{{-1081.47925, 99.9999542, 87.7701111},
                                        {-32.1072998, -183.355865, -144.607635}})
                   .met());

  // For nearly collinear vertices, in double and float, the result must not be NaN.
  const char* thin = R"([{'type': 'mesh', 'indices': [[0, 1, 2]],
                          'positions': [[0.1, 0.2, 0.3], [0.2, 0.4, 0.6], [0.3, 0.6, 0.9000000000000001]]}])";
  const auto slim = Target<double>::of_objects(thin);
  const auto slim_float = Target<float>::of_objects(thin);
  Random random(3);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3d at = Vec3d(0.1, 0.2, 0.3) * random.between(1, 3), direction = random.direction();
    const Ray<double> ray{at - direction * random.between(0, 2), direction};
    const auto hit = slim.closest(ray);
    EXPECT_FALSE(std::isnan(hit.t));
    EXPECT_FALSE(std::isnan(slim_float.closest(convert_ray<float>(ray)).t));
    if (!hit.met()) continue;
    const auto spot = slim.surface(ray, hit);
    EXPECT_FALSE(std::isnan(spot.normal.x + spot.position.x));
  }
}

// Returns the number of rays that hit the strip of two triangles from whose front they start. The strip is
// far longer than wide, so that distances along the strip are ill-conditioned.
template <class T>
int hits_of_leaving_a_strip(double length, double width) {
  const double l = length / 2, w = width / 2;
  const Json strip = {{"type", "mesh"},
                      {"positions", {{-l, -w, 0}, {l, -w, 0}, {l, w, 0}, {-l, w, 0}}},
                      {"indices", {{0, 1, 2}, {0, 2, 3}}}};
  const Target<T> shape(scene_with(strip));
  Random random(21);
  Rays<T> rays;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3d at(random.between(-l, l), random.between(-w, w), 0);
    const Vec3d from = at + random.direction_above({0, 0, 1}) * (0.4 * length);
    rays.push_back({Vec3<T>(from), Vec3<T>(safe_normalize(at - from))});
  }
  const auto hits = shape.closest(rays);
  const auto spots = shape.surfaces(rays, hits);
  Rays<T> leaving;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].met()) leaving.push_back(spots[i].leaving(Vec3<T>(random.direction_above({0, 0, 1}))));
  EXPECT_GT(leaving.size(), 15'000u);
  int met = 0;
  for (const auto& hit : shape.closest(leaving)) met += hit.met();
  return met;
}

TEST(Triangle, AvoidsSelfShadowingIfLongAndThin) {
  covers("A16");
  for (const double width : {0.6, 0.06}) EXPECT_EQ(hits_of_leaving_a_strip<float>(600, width), 0) << width;
  for (const double width : {0.6, 0.06, 0.006, 6e-6})
    EXPECT_EQ(hits_of_leaving_a_strip<double>(600, width), 0) << width;
}

// Returns the number of shadow rays that hit the triangle they leave, from points near its tip. The tip is
// `height` above a side of length 2, near the middle of this side.
template <class T>
int hits_of_leaving_an_obtuse_sliver(double height, Random& random) {
  const Vec3d along = random.direction(), normal = safe_normalize(cross(along, random.direction())),
              across = cross(normal, along), middle = random.in_cube(1);
  const auto at = [&](double x, double y) { return middle + along * x + across * y; };
  const double tip = random.between(-0.7, 0.7);
  const Json object{{"type", "triangle"},
                    {"vertices", {numbers(at(-1, 0)), numbers(at(1, 0)), numbers(at(tip, height))}}};
  const Target<T> shape(scene_with(object));
  Rays<T> rays;
  for (int i = 0; i < 500; ++i) {
    const Vec3d from = at(tip, 0) + normal * 2.0 + random.in_cube(0.15);
    const Vec3d aim = at(tip + random.between(-0.05, 0.05), random.between(0, height));
    rays.push_back({Vec3<T>(from), Vec3<T>(safe_normalize(aim - from))});
  }
  const auto hits = shape.closest(rays);
  const auto spots = shape.surfaces(rays, hits);
  Rays<T> leaving;
  const Vec3<T> light(safe_normalize(normal + random.in_cube(0.4)));
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].met()) leaving.push_back(spots[i].leaving(light));
  if (leaving.empty()) return 0;
  int met = 0;
  for (const auto& hit : shape.closest(leaving)) met += hit.met();
  return met;
}

// The cross product of the two shorter sides, which are nearly antiparallel, has few significant digits.
TEST(Triangle, AvoidsSelfShadowingOfObtuseSlivers) {
  covers("A16");
  Random random(31);
  for (int i = 0; i < 25; ++i) {
    for (const double aspect : {1e3, 1e4, 1e5, 1e6, 1e8})
      EXPECT_EQ(hits_of_leaving_an_obtuse_sliver<double>(2 / aspect, random), 0) << aspect;
    for (const double aspect : {1e3, 1e4, 1e5})
      EXPECT_EQ(hits_of_leaving_an_obtuse_sliver<float>(2 / aspect, random), 0) << aspect;
  }
}

// Rays that start exactly on a triangle miss it, in either order of its vertices.
TEST(Triangle, MissesRaysStartingOnIt) {
  for (const char* vertices :
       {"[[2, -4, -4], [2, 5, -4], [2, 0, 6]]", "[[2, -4, -4], [2, 0, 6], [2, 5, -4]]"}) {
    const Json scene = scene_with(Json{{"type", "triangle"}, {"vertices", json(vertices)}});
    const Target<double> in_double(scene);
    const Target<float> in_float(scene);
    Random random(8);
    for (int i = 0; i < 1000; ++i) {
      const Ray<double> ray{{2, 0.5, 0.25}, random.direction()};
      EXPECT_FALSE(in_double.closest(ray).met());
      EXPECT_FALSE(in_float.closest(convert_ray<float>(ray)).met());
    }
  }
}

// Returns the largest position error of rays that hit a strip from above. The strip lies in the plane y = 0
// and is `aspect` times as long as wide.
template <class T>
double slip_on_strip(double size, double aspect) {
  const double w = size / aspect / 2, l = size / 2;
  const Json strip = {{"type", "mesh"},
                      {"positions", {{-w, 0, -l}, {-w, 0, l}, {w, 0, -l}, {w, 0, l}}},
                      {"indices", {{0, 1, 2}, {1, 3, 2}}}};
  const Target<T> shape(scene_with(strip));
  Random random(6);
  double worst = 0;
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d at(random.between(-w, w), 0, random.between(-0.05, 0.05) * size);
    const Vec3d from = at + random.direction_above({0, 1, 0}) * 0.1;
    const Ray<T> ray{Vec3<T>(from), Vec3<T>(safe_normalize(at - from))};
    const auto hit = shape.closest(ray);
    if (!hit.met() || std::abs(ray.direction.y) < T(0.1)) continue;
    ++met;
    const Vec3d found(shape.surface(ray, hit).position);
    const double t = -static_cast<double>(ray.origin.y) / static_cast<double>(ray.direction.y);
    worst = std::max(worst, length(found - (Vec3d(ray.origin) + Vec3d(ray.direction) * t)));
  }
  EXPECT_GT(met, 100);
  return worst;
}

// Barycentric weights from rounded products are uncertain by eps times the aspect ratio, which would shift
// positions along the strip.
TEST(Triangle, LocatesHitsAccuratelyOnSlivers) {
  EXPECT_LE(slip_on_strip<float>(100, 1e5), 1e-5);
  EXPECT_LE(slip_on_strip<double>(100, 1e7), 1e-13);
  EXPECT_LE(slip_on_strip<double>(100, 1e9), 1e-13);
}

// Rounding the cross product of two long sides loses as many digits as the aspect ratio has.
TEST(Triangle, ComputesExactNormalsOfSlivers) {
  Random random(9);
  const auto whole = [](const Vec3d& v) { return Vec3d(std::round(v.x), std::round(v.y), std::round(v.z)); };
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = whole(random.in_cube(0x1p30)), b = whole(random.in_cube(0x1p30));
    const Vec3d c = b + whole(random.in_cube(8));
    using ExactVec = Vec3<long double>;
    const ExactVec product = cross(ExactVec(b - a), ExactVec(c - b));
    if (product == ExactVec()) continue;
    const Vec3d normal(safe_normalize(product));
    for (const Vec3d& found : {face_normal(a, b, c), face_normal(b, c, a), face_normal(c, a, b)})
      EXPECT_LE(length(found - normal), 1e-15);
  }
}

// Rays graze a sliver with sides 11.2, 9.8 and 1.4, at half a degree or less. The point at t must be near the
// triangle.
TEST(Triangle, KeepsGrazingHitsOnSlivers) {
  covers("A15");
  constexpr double kAngle = 0.52 * std::numbers::pi / 180, kFar = 600;
  const Vec3d a(0, 0, 0), b(11.2, 0, 0), c(9.79, 0.05, 0);
  const Json object{{"type", "triangle"}, {"vertices", {numbers(a), numbers(b), numbers(c)}}};
  const Target<double> shape(scene_with(object));
  Random random(5);
  int hits = 0;
  double worst = 0;
  Rays<double> rays;
  for (int i = 0; i < 1'000'000; ++i) {
    const double around = random.between(0, 2 * std::numbers::pi),
                 lift = i % 2 ? kAngle : random.magnitude(1e-6, kAngle);
    const Vec3d direction = safe_normalize(Vec3d(std::cos(around), std::sin(around), -std::sin(lift)));
    double u = random.unit(), v = random.unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    rays.push_back({a + (b - a) * u + (c - a) * v - direction * random.between(1, kFar), direction});
  }
  const auto found = shape.closest(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!found[i].met()) continue;
    ++hits;
    const Vec3d at = rays[i].at(found[i].t);
    const auto beyond = [](double p, double lo, double hi) { return std::max({lo - p, p - hi, 0.0}); };
    worst = std::max({worst, beyond(at.x, 0, 11.2), beyond(at.y, 0, c.y), beyond(at.z, 0, 0)});
  }
  EXPECT_GT(hits, 900'000);
  EXPECT_LE(worst, 1e-9 * kFar);
}

}  // namespace
}  // namespace orrery::test
