#include "core/accuracy/unit_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/stability/registry.h"
#include "tests/support/covers.h"
#include "tests/support/random.h"

namespace orrery {
namespace {

using test::covers;
using test::Random;

template <class Draw>
UnitHistogram draw(int count, const Draw& value) {
  UnitHistogram all;
  for (int i = 0; i < count; ++i) all.add(value());
  return all;
}

// If all values are 0, the bound on the mean is at most 2.5 times the rule of three, 1 - delta^(1/n).
TEST(UpperMean, FollowsRuleOfThreeWithoutEvents) {
  for (const int count : {100, 1000, 60000}) {
    const double bound = draw(count, [] { return 0.0; }).upper_mean(0.05);
    const double rule = 1 - std::pow(0.05, 1.0 / count);
    EXPECT_GE(bound, rule) << count;
    EXPECT_LE(bound, 2.5 * rule) << count;
  }
  EXPECT_EQ(UnitHistogram().upper_mean(0.05), 1);
}

TEST(UpperMean, StaysCloseToEqualValues) {
  for (const double value : {1e-6, 1e-3, 0.1, 0.5, 0.99}) {
    const double bound = draw(60000, [&] { return value; }).upper_mean(0.05);
    EXPECT_GE(bound, value);
    EXPECT_LE(bound, value * 1.2 + 2e-4) << value;
  }
  EXPECT_EQ(draw(50, [] { return 1.0; }).upper_mean(0.05), 1);
}

// A bin stores only count and sum, so all of its values count as equal.
TEST(UnitHistogram, ScalesCountsAndValues) {
  Random random(3);
  const UnitHistogram all = draw(500, [&] { return random.unit(); }), more = all.scaled(64, 0.25);
  EXPECT_NEAR(more.count(), 64 * 500, 1e-6);
  EXPECT_NEAR(more.mean(), all.mean() / 4, 1e-12);
  const UnitHistogram drawn = draw(64 * 500, [&] { return random.unit() / 4; });
  EXPECT_NEAR(more.upper_mean(0.05) / drawn.upper_mean(0.05), 1, 0.05);
}

// Most runs do not contain any of the few large values.
TEST(UpperMean, BoundsMeanOfRareErrors) {
  covers("certificate-26");
  EXPECT_LE(stability_row("certificate-26").measure().ours, 5);
}

TEST(UpperMean, BoundsMeanOfOtherDistributions) {
  Random random(2);
  const auto holds = [&](double mean, const auto& value) {
    int held = 0;
    for (int run = 0; run < 200; ++run) held += draw(500, value).upper_mean(0.05) >= mean;
    EXPECT_GE(held, 186) << mean;
  };
  holds(0.5, [&] { return random.unit(); });
  holds(1.0 / 21, [&] { return std::pow(random.unit(), 20); });
  holds(0.01, [&] { return random.unit() < 0.1 ? 0.1 : 0.0; });
}

TEST(UpperMean, IsUnchangedByMerging) {
  Random random(3);
  UnitHistogram all, first, second;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.unit() * 1e-3;
    all.add(x);
    (i % 3 == 0 ? first : second).add(x);
  }
  first.add(second);
  EXPECT_EQ(first.count(), 1000);
  EXPECT_NEAR(first.upper_mean(0.05), all.upper_mean(0.05), 1e-9);
}

}  // namespace
}  // namespace orrery
