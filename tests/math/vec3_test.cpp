#include "core/math/vec3.h"

#include <gtest/gtest.h>

#include "core/math/lanes.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

namespace orrery {
namespace {

template <class T>
class Normalize : public testing::Test {};
using Scalars = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Normalize, Scalars);

// The length differs from 1 by at most 2 machine epsilons of the type, 4.4e-16 in double.
TYPED_TEST(Normalize, GivesUnitVectorsAtAnyMagnitude) {
  using T = TypeParam;
  test::covers("A31");
  const long double tolerance = 2 * static_cast<long double>(std::numeric_limits<T>::epsilon());
  const T tiny = std::sqrt(std::numeric_limits<T>::min()) / 16,
          huge = std::sqrt(std::numeric_limits<T>::max()) * 16;
  test::Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    const Vec3<T> v = Vec3<T>(random.direction()) * (i % 3 == 0 ? tiny : i % 3 == 1 ? huge : T(1));
    const Vec3<long double> n(safe_normalize(v));
    EXPECT_LE(std::abs(length(n) - 1), tolerance) << static_cast<double>(v.x);
  }
  EXPECT_EQ(safe_normalize(Vec3<T>(tiny, tiny, 0)).x, safe_normalize(Vec3<T>(huge, huge, 0)).x);
  EXPECT_EQ(safe_normalize(Vec3<T>()), Vec3<T>());
}

TEST(Normalize, MatchesCatalogueValues) {
  test::covers("A31");
  const float half = std::sqrt(0.5f);
  EXPECT_NEAR(safe_normalize(Vec3f(1e-23f, 1e-23f, 0)).x, half, 1e-7f);
  EXPECT_NEAR(safe_normalize(Vec3f(1e20f, 1e20f, 0)).y, half, 1e-7f);
  EXPECT_NEAR(length(safe_normalize(Vec3d(1e-170, 1e-170, 0))), 1, 4e-16);
  EXPECT_NEAR(length(safe_normalize(Vec3d(1e160, 1e160, 1e160))), 1, 4e-16);
}

TEST(Vec3, SatisfiesProductIdentities) {
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d a = random.in_cube(2), b = random.in_cube(2);
    EXPECT_NEAR(dot(cross(a, b), a), 0, 1e-14);
    EXPECT_NEAR(dot(cross(a, b), b), 0, 1e-14);
    EXPECT_NEAR(dot(cross(a, b), cross(a, b)) + dot(a, b) * dot(a, b), dot(a, a) * dot(b, b), 1e-12);
  }
  EXPECT_EQ(cross(Vec3d(1, 0, 0), Vec3d(0, 1, 0)), Vec3d(0, 0, 1));
}

TEST(Vec3, IndexesComponentsByAxis) {
  Vec3d v(1, 2, 3);
  v[2] += 4;
  EXPECT_EQ(v, Vec3d(1, 2, 7));
  const Vec3<Lanes<float>> lanes(Lanes<float>(1), Lanes<float>(2), Lanes<float>(3));
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_TRUE(all(lanes[axis] == Lanes<float>(static_cast<float>(axis + 1))));
  static_assert(Vec3d(1, 2, 3)[0] == 1 && Vec3d(1, 2, 3)[1] == 2 && Vec3d(1, 2, 3)[2] == 3);
}

}  // namespace
}  // namespace orrery
