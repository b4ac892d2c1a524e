#include "core/math/depressed_cubic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/random.h"

namespace orrery::test {
namespace {

// Checks the roots of (x - a)(x - b)(x + a + b) for three real roots, and of (x + 2 a)(x^2 - 2 a x + a^2 +
// b^2) for one. The error grows near a double root.
template <class T>
void check_roots() {
  Random random(1);
  const double epsilon = static_cast<double>(std::numeric_limits<T>::epsilon());
  for (int i = 0; i < 20'000; ++i) {
    const double a = random.between(-1, 1),
                 b = random.below(2) ? random.between(-1, 1) : a + random.between(-1e-3, 1e-3);
    std::array<double, 3> exact{a, b, -a - b};
    std::sort(exact.begin(), exact.end());
    const double gap = std::min(exact[1] - exact[0], exact[2] - exact[1]);
    const double bound = std::min(std::sqrt(32 * epsilon), 32 * epsilon / gap);
    if (gap * gap < 64 * epsilon) continue;  // rounding of p and q may merge two roots
    const CubicRoots<T> roots = depressed_cubic_roots(T(-a * a - a * b - b * b), T(a * b * (a + b)));
    ASSERT_NEAR(static_cast<double>(roots.low), exact[0], bound) << a << " " << b;
    ASSERT_NEAR(static_cast<double>(roots.middle), exact[1], bound) << a << " " << b;
    ASSERT_NEAR(static_cast<double>(roots.high), exact[2], bound) << a << " " << b;
  }
  for (int i = 0; i < 20'000; ++i) {
    const double a = random.between(-1, 1), b = random.between(0.1, 2);
    const CubicRoots<T> roots = depressed_cubic_roots(T(b * b - 3 * a * a), T(2 * a * (a * a + b * b)));
    ASSERT_NEAR(static_cast<double>(roots.low), -2 * a, 64 * epsilon / b) << a << " " << b;
    ASSERT_EQ(roots.low, roots.high);
    ASSERT_EQ(roots.low, roots.middle);
  }
}

TEST(DepressedCubic, HasAccurateRootsInFloat) { check_roots<float>(); }
TEST(DepressedCubic, HasAccurateRootsInDouble) { check_roots<double>(); }

TEST(DepressedCubic, HandlesVanishingCoefficients) {
  const auto expect = [](double p, double q, double low, double middle, double high) {
    const CubicRoots<double> roots = depressed_cubic_roots(p, q);
    EXPECT_NEAR(roots.low, low, 1e-15) << p << " " << q;
    EXPECT_NEAR(roots.middle, middle, 1e-15) << p << " " << q;
    EXPECT_NEAR(roots.high, high, 1e-15) << p << " " << q;
  };
  for (const double zero : {0.0, -0.0}) {
    expect(0, zero, 0, 0, 0);
    expect(1, zero, 0, 0, 0);
    expect(-1, zero, -1, 0, 1);
    expect(zero, 8, -2, -2, -2);
    expect(zero, -8, 2, 2, 2);
  }
}

}  // namespace
}  // namespace orrery::test
