#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

namespace orrery::test {
namespace {

std::string sphere_text(const Vec3d& center, double radius) {
  return Json{{{"type", "sphere"}, {"center", numbers(center)}, {"radius", radius}}}.dump();
}
template <class T>
Target<T> sphere(const Vec3d& center, double radius) {
  return Target<T>::of_objects(sphere_text(center, radius));
}

// For rays along -z from (h, 0, D) at the unit sphere, the closed form is t = D - sqrt(1 - h^2).
TEST(Sphere, IsAccurateFromMillionRadiiAway) {
  covers("A1");
  const auto shape = sphere<double>(Vec3d(), 1);
  Random random(1);
  for (const double distance : {1.0, 10.0, 1e3, 1e4, 1e6}) {
    Rays<double> rays;
    for (int i = 0; i < 20'000; ++i) rays.push_back({{random.between(0, 1.2), 0, distance + 1}, {0, 0, -1}});
    const auto hits = shape.closest(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const long double h = static_cast<long double>(rays[i].origin.x);
      ASSERT_EQ(hits[i].met(), h <= 1) << "h " << rays[i].origin.x << " at " << distance;
      if (h > 1) continue;
      const long double exact = static_cast<long double>(rays[i].origin.z) - std::sqrt((1 - h) * (1 + h));
      // 1e-12 radii, or 2 ulp of t if those are larger.
      ASSERT_LE(std::abs(static_cast<long double>(hits[i].t) - exact), std::max(1e-12, distance * 4.5e-16))
          << h;
    }
  }
}

// Uses random directions, because rays along an axis have smaller rounding errors.
TEST(Sphere, DecidesHitsFromAfarInAnyDirection) {
  covers("A1");
  const auto shape = sphere<double>(Vec3d(), 1);
  Random random(2);
  int wrong = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vec3d direction = random.direction(), across = safe_normalize(cross(direction, random.direction()));
    const double distance = random.magnitude(1, 1e6), h = random.between(0, 1.2);
    const auto hit = shape.closest(Ray<double>{across * h - direction * distance, direction});
    if (std::abs(h - 1) > 1e-15 * distance * 4) wrong += hit.met() != (h < 1);
  }
  EXPECT_EQ(wrong, 0);
}

// In float, the distance h of the ray from the centre is known to a few ulp of the ray's length. Rays whose h
// differs from 1 by more must be decided correctly. The textbook discriminant fails for 29 % of these rays at
// a distance of 10,000.
TEST(Sphere, DecidesFloatRaysWithinFewUlp) {
  covers("A1");
  const auto shape = sphere<float>(Vec3d(), 1);
  Random random(3);
  for (const double distance : {1e2, 1e3, 1e4}) {
    const double margin = 4 * static_cast<double>(std::numeric_limits<float>::epsilon()) * distance;
    int wrong = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Vec3d direction = random.direction(),
                  across = safe_normalize(cross(direction, random.direction()));
      const Ray<float> ray{Vec3f(across * random.between(0, 1.2) - direction * distance), Vec3f(direction)};
      const Vec3d o(ray.origin), d = safe_normalize(Vec3d(ray.direction));
      const double h = length(o - d * dot(o, d));
      if (std::abs(h - 1) > margin) wrong += shape.closest(ray).met() != (h < 1);
    }
    EXPECT_EQ(wrong, 0) << distance;
  }
}

TEST(Sphere, IsAccurateWithPlanetRadius) {
  covers("A2");
  for (const double radius : {1.0, 1e3, 1e6, 1e7}) {
    const auto shape = sphere<double>(Vec3d(0, -radius, 0), radius);
    EXPECT_NEAR(shape.closest(Ray<double>{{0, 1, 0}, {0, -1, 0}}).t, 1, 1e-9) << radius;
    if (radius < 10) continue;  // the slanted ray misses
    const Vec3d slanted = safe_normalize(Vec3d(0.6, -0.8, 0));
    const auto exact = sphere<long double>(Vec3d(0, -radius, 0), radius);
    const Ray<double> ray{{0, 1, 0}, slanted};
    const auto t = static_cast<double>(exact.closest(convert_ray<long double>(ray)).t);
    EXPECT_NEAR(shape.closest(ray).t / t, 1, 1e-9) << radius;
  }
}

TEST(Sphere, SeparatesNestedShells) {
  covers("A4");
  const auto shells = Target<double>::of_objects(
      "[{'type': 'sphere', 'center': [0, 0, 0], 'radius': 1}, {'type': 'sphere', 'center': [0, 0, 0], "
      "'radius': 1.00004}]");
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d inward = random.direction();
    const Ray<double> outer{inward * -3, inward};
    const auto hit = shells.closest(outer);
    ASSERT_EQ(hit.primitive, 1);
    const auto next = shells.closest(shells.surface(outer, hit).leaving(inward));
    EXPECT_EQ(next.primitive, 0);
    EXPECT_NEAR(next.t, 4e-5, 1e-13);
  }
}

TEST(Sphere, HandlesRaysStartingOnAndInside) {
  covers("A5");
  const auto unit = sphere<double>(Vec3d(), 1);
  EXPECT_FALSE(unit.closest(Ray<double>{{1, 0, 0}, {1, 0, 0}}).met());
  EXPECT_NEAR(unit.closest(Ray<double>{{1, 0, 0}, {-1, 0, 0}}).t, 2, 1e-12);
  EXPECT_EQ(unit.closest(Ray<double>{{0, 0, 0}, {0, 1, 0}}).t, 1);
  EXPECT_NEAR(unit.closest(Ray<double>{{0.5, 0, 0}, {1, 0, 0}}).t, 0.5, 1e-15);
  const auto small = sphere<double>(Vec3d(0, 0.083, 0.4), 0.015);
  Random random(5);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3d outward = random.direction();
    const Vec3d at = Vec3d(0, 0.083, 0.4) + outward * 0.015;
    const Ray<double> ray{at + outward, -outward};
    const auto spot = small.surface(ray, small.closest(ray));
    EXPECT_FALSE(small.closest(spot.leaving(outward)).met());
    EXPECT_NEAR(small.closest(spot.leaving(-outward)).t, 0.03, 1e-12);
  }
}

TEST(Sphere, AcceptsDirectionsOfAnyLength) {
  const auto shape = sphere<double>(Vec3d(), 1);
  for (const double length : {1e-6, 0.5, 3.0, 1e6})
    EXPECT_NEAR(shape.closest(Ray<double>{{0, 0, 5}, {0, 0, -length}}).t * length, 4, 1e-12) << length;
}

}  // namespace
}  // namespace orrery::test
