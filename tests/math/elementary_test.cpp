#include "core/math/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/covers.h"
#include "tests/support/random.h"

// Compares powers and exponentials with long double, and lanes with scalars.
namespace orrery {
namespace {

using test::Random;

template <class T>
class Elementary : public testing::Test {
 public:
  static constexpr long double kUlp = std::numeric_limits<T>::epsilon();
  static constexpr T kSmallest = std::numeric_limits<T>::min(), kLargest = std::numeric_limits<T>::max();
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Elementary, Scalars);

TYPED_TEST(Elementary, ComputesLog2WithinTwoUlp) {
  using T = TypeParam;
  Random random(1);
  const auto check = [&](T x) {
    const long double exact = std::log2(static_cast<long double>(x));
    const long double error = std::abs(static_cast<long double>(log2_normal(x)) - exact);
    EXPECT_LE(error, 2 * this->kUlp * std::max(1.0L, std::abs(exact))) << "log2 of " << x;
  };
  for (int i = 0; i < 100'000; ++i)
    check(static_cast<T>(
        random.magnitude(static_cast<double>(this->kSmallest), static_cast<double>(this->kLargest) / 2)));
  for (int i = 0; i < 100'000; ++i) check(static_cast<T>(random.between(0.5, 2.0)));
  for (const T x :
       {this->kSmallest, T(1), T(2), T(0.5), std::nextafter(T(1), T(2)), std::nextafter(T(1), T(0))})
    check(x);
  EXPECT_EQ(log2_normal(T(1)), T(0));
  EXPECT_EQ(log2_normal(T(1024)), T(10));
}

TYPED_TEST(Elementary, ComputesExp2WithinTwoUlp) {
  using T = TypeParam;
  const double lowest = std::log2(static_cast<double>(this->kSmallest));
  Random random(2);
  for (int i = 0; i < 200'000; ++i) {
    const T y = static_cast<T>(random.between(lowest, -lowest - 1));
    const long double exact = std::exp2(static_cast<long double>(y));
    EXPECT_LE(std::abs(static_cast<long double>(exp2_flushed(y)) - exact), 2 * this->kUlp * exact)
        << "2^" << y;
  }
  EXPECT_EQ(exp2_flushed(T(0)), T(1));
  EXPECT_EQ(exp2_flushed(T(-7)), T(0x1p-7));
  EXPECT_EQ(exp2_flushed(static_cast<T>(lowest)), this->kSmallest);
  EXPECT_EQ(exp2_flushed(static_cast<T>(lowest) - 1), T(0));
  EXPECT_EQ(exp2_flushed(T(-1e30)), T(0));
}

// The relative error bound in the header is 2 y |log2 x| ulp, and at most 2.5e-5 (float) or 4e-13 (double)
// for normal results. Another 3 ulp allow for the exponential where the power is close to 1.
TYPED_TEST(Elementary, ComputesPowersWithinDocumentedError) {
  using T = TypeParam;
  const long double most = std::is_same_v<T, float> ? 2.5e-5L : 4e-13L;
  Random random(3);
  for (int i = 0; i < 300'000; ++i) {
    const T x = static_cast<T>(i % 2 ? random.unit() : 1 - random.magnitude(1e-7, 1.0));
    const T y = static_cast<T>(random.magnitude(1e-3, 1e6));
    if (x < this->kSmallest) continue;
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    const long double got = static_cast<long double>(pow_unit(x, y));
    if (exact < 1.0001L * static_cast<long double>(this->kSmallest)) {
      EXPECT_LE(got, 1.001L * static_cast<long double>(this->kSmallest));
    } else {
      const long double stated =
          2 * static_cast<long double>(y) * std::abs(std::log2(static_cast<long double>(x)));
      EXPECT_LE(std::abs(got - exact), exact * std::min(most, (stated + 3) * this->kUlp)) << x << "^" << y;
    }
  }
}

TYPED_TEST(Elementary, ComputesExactPowersAtEndpoints) {
  using T = TypeParam;
  test::covers("B3");
  EXPECT_EQ(pow_unit(T(0), T(0)), T(1));
  EXPECT_EQ(pow_unit(T(0.3), T(0)), T(1));
  EXPECT_EQ(pow_unit(T(0), T(2.5)), T(0));
  EXPECT_EQ(pow_unit(T(1), T(1e6)), T(1));
  EXPECT_EQ(pow_unit(std::numeric_limits<T>::denorm_min(), T(1)), T(0));
  EXPECT_EQ(pow_unit(T(0.5), T(3)), T(0.125));
}

TYPED_TEST(Elementary, MatchesScalarsBitwiseInLanes) {
  using T = TypeParam;
  using N = Lanes<T>;
  Random random(4);
  for (int i = 0; i < 20'000; ++i) {
    N x, y;
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      x[lane] = static_cast<T>(random.unit());
      y[lane] = static_cast<T>(random.magnitude(1e-2, 1e4));
    }
    const N power = pow_unit(x, y), logarithm = log2_normal(y), exponential = exp2_flushed(-y);
    for (std::size_t lane = 0; lane < N::size(); ++lane) {
      EXPECT_EQ(power[lane], pow_unit(T(x[lane]), T(y[lane])));
      EXPECT_EQ(logarithm[lane], log2_normal(T(y[lane])));
      EXPECT_EQ(exponential[lane], exp2_flushed(T(-y[lane])));
    }
  }
}

TYPED_TEST(Elementary, ComputesSineAndCosineWithinTwoUlp) {
  using T = TypeParam;
  Random random(4);
  for (int i = 0; i < 100'000; ++i) {
    const T turns = static_cast<T>(random.between(-3, 3));
    const auto [sine, cosine] = sine_cosine_turns(turns);
    const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(turns);
    EXPECT_NEAR(static_cast<double>(sine), static_cast<double>(std::sin(angle)), double(2 * this->kUlp))
        << turns;
    EXPECT_NEAR(static_cast<double>(cosine), static_cast<double>(std::cos(angle)), double(2 * this->kUlp))
        << turns;
  }
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const auto [sine, cosine] = sine_cosine_turns(T(quarter) / 4);
    EXPECT_EQ(std::abs(sine), T(std::abs(quarter % 2)));
    EXPECT_EQ(std::abs(cosine), T(1 - std::abs(quarter % 2)));
  }
}

TYPED_TEST(Elementary, ComputesDirectionTurnsWithinTwoUlp) {
  using T = TypeParam;
  Random random(5);
  for (int i = 0; i < 100'000; ++i) {
    const T x = static_cast<T>(random.between(-1, 1) * random.magnitude(1e-6, 1e6)),
            y = static_cast<T>(random.between(-1, 1) * random.magnitude(1e-6, 1e6));
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x)) /
                              (2 * std::numbers::pi_v<long double>);
    EXPECT_NEAR(static_cast<double>(direction_turns(x, y)), static_cast<double>(exact),
                double(2 * this->kUlp))
        << x << ", " << y;
  }
  EXPECT_EQ(direction_turns(T(0), T(0)), T(0));
  EXPECT_EQ(direction_turns(T(0), T(2)), T(0.25));
  EXPECT_EQ(positive_turns(T(0), T(-2)), T(0.75));
}

}  // namespace
}  // namespace orrery
