#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/lights/emitters.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

// Compares solid angles of emitters with closed forms.
namespace orrery::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct Square {
  Vec3d corner, a, b;  // corner relative to the point, unit directions of the sides
  double length_a, length_b;
};
template <class T>
double angle_of(const Square& s) {
  return double{SphericalRectangle<T>(Vec3<T>(s.corner), Vec3<T>(s.a), static_cast<T>(s.length_a),
                                      Vec3<T>(s.b), static_cast<T>(s.length_b), Vec3<T>(cross(s.a, s.b)))
                    .angle()};
}
// Checks float only above 0.02 sr, because smaller emitters are sampled by area.
void expect_angle(const Square& square, double expected) {
  EXPECT_NEAR(angle_of<double>(square), expected, 1e-12);
  if (expected > 0.02) {
    EXPECT_NEAR(angle_of<float>(square), expected, 1e-5);
  }
}

// Unit squares seen from above their centre, and a quarter plane, which fills one octant.
TEST(SolidAngle, MatchesClosedFormForRectangles) {
  covers("light-18");
  const Vec3d x(1, 0, 0), z(0, 0, 1);
  for (const auto& [height, expected] :
       {std::pair{1.0, 4 * std::asin(0.2)}, {0.5, 2 * kPi / 3}, {2.0, 4 * std::asin(1.0 / 17)}})
    expect_angle({Vec3d(-0.5, height, -0.5), x, z, 1, 1}, expected);
  ASSERT_NEAR(4 * std::asin(0.2), 0.805432, 1e-6);
  expect_angle({Vec3d(0, 1, 0), x, z, 1e14, 1e14}, kPi / 2);
}

// Returns the solid angle of a triangle, in higher precision (Van Oosterom and Strackee, "The Solid Angle of
// a Plane Triangle", 1983).
long double triangle_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto dot3 = [](const Vec3d& p, const Vec3d& q) {
    return static_cast<long double>(p.x) * q.x + static_cast<long double>(p.y) * q.y +
           static_cast<long double>(p.z) * q.z;
  };
  const long double la = std::sqrt(dot3(a, a)), lb = std::sqrt(dot3(b, b)), lc = std::sqrt(dot3(c, c));
  const long double volume =
      a.x * (static_cast<long double>(b.y) * c.z - static_cast<long double>(b.z) * c.y) +
      a.y * (static_cast<long double>(b.z) * c.x - static_cast<long double>(b.x) * c.z) +
      a.z * (static_cast<long double>(b.x) * c.y - static_cast<long double>(b.y) * c.x);
  return 2 * std::atan2(std::abs(volume), la * lb * lc + dot3(a, b) * lc + dot3(a, c) * lb + dot3(b, c) * la);
}

TEST(SolidAngle, EqualsSumOfTwoTrianglesForRectangles) {
  covers("light-18");
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d a = random.direction(), b = perpendicular(a), corner = random.in_cube(2);
    const double la = random.magnitude(0.1, 3), lb = random.magnitude(0.1, 3);
    const Vec3d second = corner + a * la, third = second + b * lb, fourth = corner + b * lb;
    const long double expected =
        triangle_angle(corner, second, third) + triangle_angle(corner, third, fourth);
    expect_angle({corner, a, b, la, lb}, static_cast<double>(expected));
  }
}

// A sphere is sampled uniformly over the cone that it subtends, so its density is 1 / solid angle.
TEST(SolidAngle, EqualsConeForSpheres) {
  covers("light-18");
  for (const auto& [radius, distance] : {std::pair{0.5, 2.0}, {0.9, 1.0}, {1.0, 10.0}, {0.001, 3.0}}) {
    const Vec3d centre(0.3, -0.2, 0.7), to = safe_normalize(Vec3d(1, 2, -2));
    const auto emitter = make_emitter({Patch::Kind::sphere, centre, Vec3d(radius, 0, 0), Vec3d()}, Vec3d(1));
    const double pdf = emitter.pdf({centre - to * distance, to}, distance - radius);
    const double sine = radius / distance, cosine = std::sqrt((1 - sine) * (1 + sine));
    EXPECT_NEAR(1 / pdf, 2 * kPi * sine * sine / (1 + cosine), 1e-12);
  }
}

}  // namespace
}  // namespace orrery::test
