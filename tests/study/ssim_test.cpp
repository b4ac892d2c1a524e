#include "core/study/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/image/srgb.h"

// Compares structural similarity with closed forms.
namespace orrery::test {
namespace {

constexpr double kC1 = 1e-4, kC2 = 9e-4;

// Returns grey pixels from display values.
std::vector<float> grey(const std::vector<double>& shown) {
  std::vector<float> values;
  for (const double code : shown)
    for (int channel = 0; channel < 3; ++channel) values.push_back(decode_srgb(static_cast<float>(code)));
  return values;
}

TEST(Ssim, IsOneForEqualImages) {
  std::vector<double> shown;
  for (int i = 0; i < 35; ++i) shown.push_back(0.5 + 0.4 * std::sin(i));
  EXPECT_NEAR(ssim(grey(shown), grey(shown), 7), 1, 1e-12);
  EXPECT_NEAR(ssim(grey({0.3}), grey({0.3}), 1), 1, 1e-12);
}

TEST(Ssim, ComparesLumaOfFlatImages) {
  const std::vector<double> dark(20 * 15, 0.2), bright(20 * 15, 0.8);
  EXPECT_NEAR(ssim(grey(dark), grey(bright), 20), (2 * 0.16 + kC1) / (0.04 + 0.64 + kC1), 1e-5);
}

// A pattern of alternating columns and its negative have equal means, and a covariance of -variance. Far from
// the edges the weights of even and odd columns agree to 1e-5.
TEST(Ssim, IsNegativeForInvertedPattern) {
  constexpr int kWidth = 200;
  std::vector<double> pattern, negative;
  for (int i = 0; i < kWidth * 3; ++i) {
    const double step = i % kWidth % 2 == 0 ? 0.1 : -0.1;
    pattern.push_back(0.5 + step);
    negative.push_back(0.5 - step);
  }
  EXPECT_NEAR(ssim(grey(pattern), grey(negative), kWidth), (kC2 - 0.02) / (kC2 + 0.02), 0.005);
  EXPECT_NEAR(ssim(grey(pattern), grey(std::vector(pattern.size(), 0.5)), kWidth), kC2 / (kC2 + 0.01), 0.01);
}

TEST(Ssim, ClampsToDisplayRange) {
  std::vector<double> shown(100, 0.25);
  std::vector<float> brighter = grey(std::vector(100, 1.0)), white = brighter;
  for (float& value : brighter) value = 7;
  EXPECT_NEAR(ssim(brighter, white, 10), 1, 1e-12);
  std::vector<float> broken = grey(shown);
  broken[30] = std::numeric_limits<float>::quiet_NaN();
  const double found = ssim(broken, grey(shown), 10);
  EXPECT_GT(found, 0);
  EXPECT_LT(found, 1);
}

TEST(Ssim, IsInvariantUnderTransposition) {
  constexpr int kWidth = 12, kHeight = 9;
  std::vector<double> a, b, a_turned, b_turned;
  const auto code = [](int x, int y, int seed) { return 0.5 + 0.4 * std::sin(3.1 * x + 1.7 * y + seed); };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) a.push_back(code(x, y, 0)), b.push_back(code(x, y, 1));
  for (int x = 0; x < kWidth; ++x)
    for (int y = 0; y < kHeight; ++y) a_turned.push_back(code(x, y, 0)), b_turned.push_back(code(x, y, 1));
  EXPECT_NEAR(ssim(grey(a), grey(b), kWidth), ssim(grey(a_turned), grey(b_turned), kHeight), 1e-9);
}

}  // namespace
}  // namespace orrery::test
