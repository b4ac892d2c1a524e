#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

namespace orrery::test {
namespace {

constexpr const char* kEndless = "[{'type': 'cylinder', 'point': [0, 0, 0], 'axis': [0, 0, 1], 'radius': 1}]";
constexpr const char* kCapped = "[{'type': 'cylinder', 'base': [0, 0, 0], 'top': [0, 0, 1], 'radius': 1}]";

// Ray parameters of entry and exit, or -1 for a miss.
struct Crossing {
  double enter, leave;
};
template <class T>
Crossing crossing(const Target<T>& shape, const Ray<double>& ray) {
  const auto first = shape.closest(convert_ray<T>(ray));
  if (!first.met()) return {-1, -1};
  const double middle = static_cast<double>(first.t) * (1 + 1e-3);
  const auto second = shape.closest(convert_ray<T>(Ray<double>{ray.at(middle), ray.direction}));
  return {static_cast<double>(first.t), middle + static_cast<double>(second.t)};
}

// The roots are (-B -+ sqrt D) / (2 A). With A != 1, the results would differ if only sqrt D were divided.
TEST(Cylinder, DividesRootsByTwiceA) {
  covers("A7");
  const auto check = [](const Ray<double>& ray, double enter, double leave) {
    const Crossing d = crossing(Target<double>::of_objects(kEndless), ray);
    EXPECT_NEAR(d.enter, enter, 1e-12 * leave);
    EXPECT_NEAR(d.leave, leave, 1e-12 * leave);
    const Crossing f = crossing(Target<float>::of_objects(kEndless), ray);
    // Rounding of the direction, 6e-8, is amplified by up to 1 / 0.1^2.
    EXPECT_NEAR(f.enter, enter, 1e-5 * leave);
  };
  check({{-5, 0, 0}, {0.6, 0, 0.8}}, 6.666666666666667, 10);
  check({{-5, 0, 0}, {2, 0, 0}}, 2, 3);
  check({{-5, 0, 0}, {0.1, 0, std::sqrt(0.99)}}, 40, 60);
  check({{-5, 0, 0}, {1, 0, 0}}, 4, 6);
}

TEST(Cylinder, HitsCapsAlongAxis) {
  covers("A8");
  const auto capped = Target<double>::of_objects(kCapped);
  for (const double slant : {0.0, 1e-10, -1e-10, 1e-200, 1e-310})
    EXPECT_NEAR(capped.closest(Ray<double>{{0.5, 0, -5}, {slant, 0, 1}}).t, 5, 1e-12) << slant;
  EXPECT_FALSE(capped.closest(Ray<double>{{1.5, 0, -5}, {0, 0, 1}}).met());
  EXPECT_NEAR(capped.closest(Ray<double>{{0.5, 0, 5}, {0, 0, -1}}).t, 4, 1e-12);
  EXPECT_NEAR(capped.closest(Ray<double>{{0.5, 0, 0.5}, {0, 0, 1}}).t, 0.5, 1e-12) << "from inside";
  const auto in_float = Target<float>::of_objects(kCapped);
  EXPECT_NEAR(in_float.closest(Ray<float>{{0.5f, 0, -5}, {0, 0, 1}}).t, 5, 1e-6f);
  EXPECT_NEAR(in_float.closest(Ray<float>{{0.5f, 0, -5}, {1e-30f, 0, 1}}).t, 5, 1e-6f);

  const auto endless = Target<double>::of_objects(kEndless);
  EXPECT_FALSE(endless.closest(Ray<double>{{0.5, 0, -5}, {0, 0, 1}}).met());
  EXPECT_FALSE(endless.closest(Ray<double>{{1.5, 0, -5}, {0, 0, 1}}).met());
}

// Along an axis that doubles cannot represent exactly, the perpendicular component is rounding noise.
TEST(Cylinder, HitsCapsAlongSlantedAxis) {
  covers("A8");
  Random random(1);
  for (int i = 0; i < 2'000; ++i) {
    const Vec3d axis = random.direction(), beside = safe_normalize(cross(axis, random.direction()));
    const Json object{
        {"type", "cylinder"}, {"base", numbers(Vec3d())}, {"top", numbers(axis)}, {"radius", 1}};
    const Target<double> shape(scene_with(object));
    EXPECT_NEAR(shape.closest(Ray<double>{beside * 0.5 - axis * 5, axis}).t, 5, 1e-12);
    EXPECT_FALSE(shape.closest(Ray<double>{beside * 1.5 - axis * 5, axis}).met());
  }
}

// A cap centre at the origin must not select the infinite cylinder, which has different keys in a scene.
TEST(Cylinder, TreatsOriginAsOrdinaryCapCentre) {
  covers("A9");
  const Ray<double> above{{-5, 0, 100}, {1, 0, 0}};
  const auto met = [&](const char* object) { return Target<double>::of_objects(object).closest(above); };
  EXPECT_FALSE(met(kCapped).met());
  EXPECT_FALSE(met("[{'type': 'cylinder', 'base': [0, 0, 1], 'top': [0, 0, 0], 'radius': 1}]").met());
  EXPECT_FALSE(met("[{'type': 'cylinder', 'base': [0, 0, -1], 'top': [0, 0, 0], 'radius': 1}]").met());
  EXPECT_NEAR(met(kEndless).t, 4, 1e-12);
}

// Rays through the rim hit cap and wall at the same point. At least one of the two must accept the hit.
TEST(Cylinder, DoesNotLeakAtRim) {
  covers("A10");
  const auto capped = Target<double>::of_objects(kCapped);
  Random random(2);
  int leaks = 0, odd = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double angle = random.between(0, 2 * std::numbers::pi);
    const Vec3d outward(std::cos(angle), std::sin(angle), 0), rim = outward + Vec3d(0, 0, 1);
    const Vec3d aside(-outward.y, outward.x, 0);
    const Vec3d direction =
        safe_normalize(outward * -random.magnitude(1e-3, 1) + Vec3d(0, 0, -random.magnitude(1e-3, 1)) +
                       aside * random.between(-0.2, 0.2) * random.unit());
    // The ray enters the body if a point shortly after the rim is inside the body.
    const Vec3d later = rim + direction * 1e-4;
    if (later.x * later.x + later.y * later.y > 1 - 1e-9) continue;
    const Ray<double> ray{rim - direction * random.between(0.5, 5), direction};
    leaks += !capped.closest(ray).met();
    const auto back = capped.closest(Ray<double>{later, -direction}),
               on = capped.closest(Ray<double>{later, direction});
    odd += std::abs(back.t - 1e-4) > 1e-12 || !on.met() ||
           capped.closest(Ray<double>{later + direction * (on.t + 1e-9), direction}).met();
  }
  EXPECT_EQ(leaks, 0);
  EXPECT_EQ(odd, 0);
}

// For a ray in the plane of a cap, the distance to the cap is 0 / 0. This NaN must not affect the hit on the
// wall.
TEST(Cylinder, HitsWallInPlaneOfCap) {
  const auto check = [](const auto& capped, auto number) {
    using T = decltype(number);
    for (const T side : {T(1), T(-1)}) {
      for (const T height : {T(0), T(1)}) {
        EXPECT_EQ(capped.closest(Ray<T>{{-5 * side, 0, height}, {side, 0, 0}}).t, 4) << height;
        EXPECT_EQ(capped.closest(Ray<T>{{0, 0, height}, {0, side, 0}}).t, 1) << "from inside, " << height;
      }
      for (const T height : {T(-1), T(2)})
        EXPECT_FALSE(capped.closest(Ray<T>{{-5 * side, 0, height}, {side, 0, 0}}).met()) << height;
    }
  };
  check(Target<double>::of_objects(kCapped), double());
  check(Target<float>::of_objects(kCapped), float());
}

TEST(Cylinder, IsHitFromInside) {
  covers("A11");
  const auto shape = Target<double>::of_objects(
      "[{'type': 'cylinder', 'point': [0, 0, 0], 'axis': [0, 1, 0], 'radius': 0.5}]");
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.between(0, 2 * std::numbers::pi);
    EXPECT_NEAR(shape.closest(Ray<double>{{0, 3, 0}, {std::cos(angle), 0, std::sin(angle)}}).t, 0.5, 1e-12);
  }
}

}  // namespace
}  // namespace orrery::test
