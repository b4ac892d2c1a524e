#include "core/math/bounds.h"

#include <gtest/gtest.h>

#include <array>

#include "core/stability/corner_ray.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

// Tests that the box test misses no ray that touches the box.
namespace orrery {
namespace {

template <class T>
class SlabTest : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SlabTest, Scalars);

TYPED_TEST(SlabTest, MissesNoneOfMillionRaysThroughCorners) {
  using T = TypeParam;
  test::covers("A27");
  test::Random random(7);
  int lost = 0;
  constexpr int kRays = 1'000'000;
  for (int i = 0; i < kRays; ++i) {
    const T unit =
        std::ldexp(T(1), 1 - std::numeric_limits<T>::digits + random.below(21));  // coordinates 1 .. 1e6
    lost += !ray_through_a_corner(random, unit).enters_it();
  }
  EXPECT_EQ(lost, 0);
}

TYPED_TEST(SlabTest, FindsRayMissedByTextbookMethod) {
  using T = TypeParam;
  test::covers("A27");
  BoxTest<T> b;
  b.lo = Vec3<T>(Vec3<float>(.941331983f, .680011868f, 1.49681544f));
  b.hi = Vec3<T>(Vec3<float>(.94203943f, .680708647f, 1.49681544f));
  b.origin = Vec3<T>(Vec3<float>(7.3407073f, 7.95443916f, -7.36857891f));
  b.direction = Vec3<T>(Vec3<float>(-6.39937544f, -7.27442741f, 8.86539459f));
  EXPECT_TRUE(b.enters_it());
}

// Rays in the plane of a face compute 0 * infinity. Four of these places touch the unit cube, two do not.
// Each place is tested for every axis, both signs of the direction and both signs of its zeros.
TYPED_TEST(SlabTest, AcceptsOnlyTouchingRaysInFacePlanes) {
  using T = TypeParam;
  test::covers("A28");
  struct Place {
    T across, other;
    bool touches;
  };
  const std::array<Place, 6> places = {{{0, T(.5), true},
                                        {1, T(.5), true},
                                        {0, 1, true},
                                        {T(.25), T(.75), true},
                                        {2, T(.5), false},
                                        {T(.5), -1, false}}};
  const auto permuted = [](T along, T across, T other, int axis) {
    return axis == 0   ? Vec3<T>(along, across, other)
           : axis == 1 ? Vec3<T>(other, along, across)
                       : Vec3<T>(across, other, along);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const T zero : {T(0), -T(0)})
      for (const T along : {T(1), T(-1)})
        for (const Place& place : places) {
          BoxTest<T> b;
          b.lo = Vec3<T>(T(0));
          b.hi = Vec3<T>(T(1));
          b.origin = permuted(along > 0 ? T(-1) : T(2), place.across, place.other, axis);
          b.direction = permuted(along, zero, zero, axis);
          b.start_from_zero();
          EXPECT_EQ(b.enters_it(), place.touches)
              << "axis " << axis << " zero " << zero << " at " << place.across << ", " << place.other;
        }
}

TYPED_TEST(SlabTest, MatchesScalarsBitwiseInLanes) {
  using T = TypeParam;
  using N = Lanes<T>;
  test::Random random(9);
  for (int i = 0; i < 5'000; ++i) {
    BoxTest<N> lanes;
    std::array<BoxTest<T>, N::size()> each;
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      each[lane] = ray_through_a_corner(random, T(1));
      each[lane].direction = each[lane].direction + Vec3<T>(random.direction());
      if (random.below(4) == 0) each[lane].direction.y = -T(0);
      const auto set = [&](Vec3<N> BoxTest<N>::*to, const Vec3<T>& v) {
        (lanes.*to).x[lane] = v.x, (lanes.*to).y[lane] = v.y, (lanes.*to).z[lane] = v.z;
      };
      set(&BoxTest<N>::lo, each[lane].lo);
      set(&BoxTest<N>::hi, each[lane].hi);
      set(&BoxTest<N>::origin, each[lane].origin);
      set(&BoxTest<N>::direction, each[lane].direction);
    }
    const auto entered = lanes.enters_it();
    for (std::size_t lane = 0; lane < N::size(); ++lane) EXPECT_EQ(entered[lane], each[lane].enters_it());
  }
}

TYPED_TEST(SlabTest, TestsOnlyBetweenOriginAndEnd) {
  using T = TypeParam;
  const Vec3<T> lo(T(1)), hi(T(2)), up(T(1), T(1), T(1));
  const BoxRay<T> ray(Vec3<T>(T(0)), up);
  EXPECT_TRUE(enters(ray, lo, hi, T(1)));
  EXPECT_FALSE(enters(ray, lo, hi, T(0.99)));
  EXPECT_FALSE(enters(ray, lo, hi, T(-1))) << "inactive ray";
  EXPECT_FALSE(enters(BoxRay<T>(Vec3<T>(T(0)), -up), lo, hi, T(100)));
  EXPECT_TRUE(enters(BoxRay<T>(Vec3<T>(T(1.5)), up), lo, hi, T(0.1))) << "origin inside the box";
}

TEST(Bounds, CoversFloatRoundingIfPadded) {
  test::Random random(11);
  for (int i = 0; i < 10'000; ++i) {
    const double scale = random.magnitude(1e-6, 1e6);
    Boundsd b;
    b.include(random.in_cube(scale));
    b.include(random.in_cube(scale));
    const Bounds<float> grown = padded<float>(b);
    EXPECT_LT(static_cast<double>(grown.lo.x), b.lo.x);
    EXPECT_GT(static_cast<double>(grown.hi.z), b.hi.z);
  }
}

// The lower bounds of an empty box are +infinity, the upper bounds -infinity.
TEST(Bounds, IgnoresEmptyBox) {
  Boundsd b = Boundsd::of({{-1, 2, 3}, {4, 5, 6}});
  b.include(Boundsd());
  EXPECT_EQ(b.lo, Vec3d(-1, 2, 3));
  EXPECT_EQ(b.hi, Vec3d(4, 5, 6));
}

}  // namespace
}  // namespace orrery
