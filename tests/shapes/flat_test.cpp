#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

// Tests planes, disks and boxes: rays in their faces, along their edges, and to the horizon.
namespace orrery::test {
namespace {

constexpr const char* kFloor = "[{'type': 'plane', 'point': [0, 0, 0], 'normal': [0, 0, 1]}]";
constexpr const char* kCube = "[{'type': 'box', 'min': [0, 0, 0], 'max': [1, 1, 1]}]";

template <class T>
class FlatShapes : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FlatShapes, Scalars);

TYPED_TEST(FlatShapes, MissesRaysParallelToPlane) {
  using T = TypeParam;
  covers("A37");
  const auto plane = Target<T>::of_objects(kFloor);
  EXPECT_FALSE(plane.closest(Ray<T>{{0, 0, 1}, {1, 0, 0}}).met());
  EXPECT_FALSE(plane.closest(Ray<T>{{0, 0, 1}, {1, 0, -T(0)}}).met());
  EXPECT_FALSE(plane.closest(Ray<T>{{0, 0, 0}, {1, 0, 0}}).met()) << "in the plane";
  const auto disk =
      Target<T>::of_objects("[{'type': 'disk', 'center': [0, 0, 0], 'normal': [0, 0, 1], 'radius': 1}]");
  EXPECT_FALSE(disk.closest(Ray<T>{{-5, 0, 0}, {1, 0, 0}}).met()) << "in the plane of the disk";
  EXPECT_FALSE(disk.closest(Ray<T>{{-5, 0, 1}, {1, 0, 0}}).met());
}

TYPED_TEST(FlatShapes, FindsPlaneAtAnySlant) {
  using T = TypeParam;
  covers("A37");
  const auto plane = Target<T>::of_objects(kFloor);
  const double tolerance = 1e-12 + 4 * static_cast<double>(std::numeric_limits<T>::epsilon());
  for (double slope = 1; slope > 1e-30; slope /= 1000) {
    const auto hit = plane.closest(Ray<T>{{0, 0, 1}, {1, 0, static_cast<T>(-slope)}});
    EXPECT_NEAR(static_cast<double>(hit.t) * slope, 1, tolerance) << slope;
  }
}

// If the distance overflows or nearly does, the ray misses or its surface point has finite coordinates.
TEST(Plane, StaysFiniteAtHorizon) {
  covers("A37");
  const auto plane = Target<double>::of_objects(kFloor);
  for (const double slope : {1e-100, 1e-300, 1e-307, 5e-324}) {
    const Ray<double> ray{{0, 0, 1}, {1, 0, -slope}};
    const auto hit = plane.closest(ray);
    EXPECT_FALSE(std::isnan(hit.t));
    if (!hit.met()) continue;
    EXPECT_NEAR(hit.t * slope, 1, 1e-12);
    const auto spot = plane.surface(ray, hit);
    EXPECT_TRUE(std::isfinite(spot.position.x + spot.position.z + spot.normal.z)) << slope;
  }
}

TYPED_TEST(FlatShapes, EndsDisksAtRadius) {
  using T = TypeParam;
  const auto disk =
      Target<T>::of_objects("[{'type': 'disk', 'center': [1, 0, 0], 'normal': [0, 0, 1], 'radius': 2}]");
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    const double angle = random.between(0, 2 * std::numbers::pi), from_center = random.between(0, 3);
    if (std::abs(from_center - 2) < 1e-5) continue;
    const Ray<T> ray{Vec3<T>(Vec3d(1 + from_center * std::cos(angle), from_center * std::sin(angle), 5)),
                     {0, 0, -1}};
    EXPECT_EQ(disk.closest(ray).met(), from_center < 2);
  }
}

// Rays in the plane of a face compute 0 * infinity. Tests six places for each axis, sign of the direction and
// sign of zero.
TYPED_TEST(FlatShapes, HitsBoxesWithRaysInFacePlanes) {
  using T = TypeParam;
  covers("A28");
  const auto cube = Target<T>::of_objects(kCube);
  struct Place {
    T across, other;
    bool touches;
  };
  for (const Place& place : {Place{0, T(.5), true}, Place{1, T(.5), true}, Place{0, 1, true},
                             Place{1, 0, true}, Place{2, T(.5), false}, Place{T(.5), -1, false}})
    for (int axis = 0; axis < 3; ++axis)
      for (const T zero : {T(0), -T(0)})
        for (const T along : {T(1), T(-1)}) {
          const auto turned = [axis](T a, T b, T c) {
            return axis == 0 ? Vec3<T>(a, b, c) : axis == 1 ? Vec3<T>(c, a, b) : Vec3<T>(b, c, a);
          };
          const Ray<T> ray{turned(along > 0 ? T(-1) : T(2), place.across, place.other),
                           turned(along, zero, zero)};
          const auto hit = cube.closest(ray);
          EXPECT_EQ(hit.met(), place.touches) << axis << " " << along << " " << zero << " " << place.across;
          if (hit.met()) {
            EXPECT_EQ(hit.t, 1);
          }
        }
}

TEST(Box, IsHitFromInsideAndThroughCorners) {
  const auto cube = Target<double>::of_objects(kCube);
  EXPECT_NEAR(cube.closest(Ray<double>{{0.5, 0.5, 0.5}, {0, 0, -1}}).t, 0.5, 1e-15);
  const Vec3d diagonal = safe_normalize(Vec3d(1, 1, 1));
  EXPECT_NEAR(cube.closest(Ray<double>{diagonal * -2, diagonal}).t, 2, 1e-15);
  EXPECT_FALSE(cube.closest(Ray<double>{{2, 2, 2}, diagonal}).met()) << "behind the origin";
}

TEST(Box, ReportsNormalOfHitFace) {
  const auto cube = Target<double>::of_objects("[{'type': 'box', 'min': [-3, -1, -2], 'max': [1, 5, 4]}]");
  Random random(4);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      const Vec3d normal = axis == 0 ? Vec3d(side, 0, 0) : axis == 1 ? Vec3d(0, side, 0) : Vec3d(0, 0, side);
      for (int i = 0; i < 100; ++i) {
        const Vec3d near = Vec3d(-1, 2, 1) + Vec3d(1.9, 2.9, 2.9) * random.in_cube(1);
        const Vec3d from = near + normal * 20;
        const Ray<double> ray{from, -normal};
        EXPECT_EQ(cube.surface(ray, cube.closest(ray)).outward(), normal);
      }
    }
}

}  // namespace
}  // namespace orrery::test
