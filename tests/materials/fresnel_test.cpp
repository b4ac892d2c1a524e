#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Case = Probe<double>::Case;
using Complex = std::complex<long double>;

Probe<double> glass(double ior, const char* fresnel) {
  return Probe<double>(Json{{"type", "refractive"}, {"ior", ior}, {"fresnel", fresnel}});
}
Probe<double> metal(double n, double k, const char* fresnel) {
  return Probe<double>(
      Json{{"type", "reflective"}, {"n", {n, n, n}}, {"k", {k, k, k}}, {"fresnel", fresnel}});
}

Case arriving(long double degrees, double side = 1) {
  const long double a = degrees * std::numbers::pi_v<long double> / 180;
  Case c;
  c.direction = Vec3d(static_cast<double>(std::sin(a)), 0, static_cast<double>(-std::cos(a)));
  c.side = side;
  return c;
}
double reflectance(const Probe<double>& material, long double degrees, double side = 1) {
  return material.specular(arriving(degrees, side)).reflectance.x;
}

// Returns the unpolarised Fresnel reflectance from index n1 into n2, by the textbook equations with complex
// numbers.
long double textbook(Complex n1, Complex n2, long double degrees) {
  const long double a = degrees * std::numbers::pi_v<long double> / 180;
  const Complex c1 = std::cos(a), s2 = n1 / n2 * std::sin(a), c2 = std::sqrt(Complex(1) - s2 * s2);
  const Complex s = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2), p = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
  return (std::norm(s) + std::norm(p)) / 2;
}

TEST(Fresnel, MatchesTextbookForDielectrics) {
  covers("D6 D7");
  for (const double ior : {1.01, 1.1, 1.333, 1.5, 2.417, 0.7}) {
    const Probe<double> exact = glass(ior, "exact");
    for (long double degrees = 0; degrees < 90; degrees += 0.37L) {
      EXPECT_NEAR(reflectance(exact, degrees), static_cast<double>(textbook(1, ior, degrees)), 1e-12) << ior;
      const long double sine = std::sin(degrees * std::numbers::pi_v<long double> / 180);
      if (sine * ior > 0.999L) continue;
      EXPECT_NEAR(reflectance(exact, degrees, -1), static_cast<double>(textbook(ior, 1, degrees)), 1e-12)
          << ior;
    }
  }
}

TEST(Fresnel, MatchesCatalogueValues) {
  covers("D6 D7");
  const Probe<double> exact = glass(1.5, "exact");
  EXPECT_NEAR(reflectance(exact, 45), .0502399, 5e-8);
  EXPECT_NEAR(reflectance(exact, 56.309932474020215L), .0739645, 5e-8);
  EXPECT_NEAR(reflectance(exact, 40, -1), .2453, 5e-5);
  EXPECT_NEAR(reflectance(exact, 41.8, -1), .8908, 5e-5);
  EXPECT_NEAR(reflectance(exact, 0), 0.04, 1e-15);
  for (const long double degrees : {0.0L, 30.0L, 60.0L, 89.0L})
    EXPECT_NEAR(reflectance(glass(1, "exact"), degrees), 0, 1e-15);
}

// Compares the largest error of Schlick's approximation with the documented value, on both sides of the
// surface. The approximation uses the cosine on the optically thinner side.
TEST(Fresnel, HasDocumentedSchlickError) {
  covers("D6 D7");
  const auto worst = [](const Probe<double>& schlick, const Probe<double>& exact, double side) {
    std::vector<Case> cases;
    for (long double degrees = 0; degrees < 90; degrees += 0.01L) cases.push_back(arriving(degrees, side));
    const auto a = schlick.specular(cases), b = exact.specular(cases);
    double largest = 0;
    for (std::size_t i = 0; i < cases.size(); ++i)
      largest = std::max(largest, std::abs(a[i].reflectance.x - b[i].reflectance.x));
    return largest;
  };
  struct Row {
    double ior, error;
  };
  for (const Row& row : {Row{1.01, .55}, Row{1.1, .21}, Row{1.333, .059}, Row{1.5, .036}, Row{2.417, .075}}) {
    EXPECT_NEAR(worst(glass(row.ior, "schlick"), glass(row.ior, "exact"), 1), row.error, 0.006) << row.ior;
    EXPECT_NEAR(worst(glass(row.ior, "schlick"), glass(row.ior, "exact"), -1), row.error, 0.02)
        << row.ior << " inside";
  }
  EXPECT_NEAR(worst(metal(1.10, 6.79, "schlick"), metal(1.10, 6.79, "exact"), 1), .10, 0.006) << "aluminium";
  EXPECT_NEAR(worst(metal(3.2, 3.3, "schlick"), metal(3.2, 3.3, "exact"), 1), .20, 0.006) << "chromium";
  EXPECT_NEAR(reflectance(glass(1, "schlick"), 89.9L), 1, 0.01)
      << "with n = 1, the approximation reflects grazing rays";
  EXPECT_LE(std::abs(reflectance(glass(1.5, "schlick"), 41.8, -1) - .8908), .06)
      << "with the cosine inside the glass, the reflectance would be .0410";
}

TEST(Fresnel, MatchesTextbookForConductors) {
  covers("D7");
  for (const auto& [n, k] : {std::pair{1.10, 6.79}, {3.2, 3.3}, {0.14, 4.1}, {0.2, 3.9}, {1.5, 0.0}}) {
    const Probe<double> exact = metal(n, k, "exact");
    for (long double degrees = 0; degrees < 90; degrees += 0.37L)
      EXPECT_NEAR(reflectance(exact, degrees), static_cast<double>(textbook(1, Complex(n, k), degrees)),
                  1e-12)
          << n << " " << k;
  }
}

TEST(Fresnel, StaysInUnitIntervalAndReachesOneAtGrazing) {
  covers("A32");
  Random random(1);
  for (const char* fresnel : {"schlick", "exact"})
    for (const Probe<double>& material :
         {glass(1.5, fresnel), glass(0.01, fresnel), glass(100, fresnel), metal(0, 0, fresnel),
          metal(0, 5, fresnel), metal(1e6, 1e6, fresnel), metal(0.14, 4.1, fresnel)}) {
      std::vector<Case> cases(10'000);
      for (Case& c : cases) {
        c.direction = -random.direction_above(c.normal);
        c.side = random.below(2) ? 1 : -1;
      }
      for (const auto& s : material.specular(cases)) {
        EXPECT_TRUE(s.reflectance.x >= 0 && s.reflectance.x <= 1 + 1e-15) << s.reflectance.x;
        EXPECT_TRUE(s.transmittance.x >= 0 && s.transmittance.x <= 1);
      }
    }
  EXPECT_NEAR(reflectance(glass(1.5, "schlick"), 90), 1, 1e-15);
  EXPECT_NEAR(reflectance(glass(1.5, "exact"), 90), 1, 1e-15);
  EXPECT_NEAR(reflectance(metal(0.14, 4.1, "exact"), 90), 1, 1e-15);
}

// An interpolated normal may face away from the incident ray. (1 - cosine) is then above 1, and its fifth
// power would amplify light up to 32 times.
TEST(Fresnel, CreatesNoLightForBackfacingNormals) {
  for (const Probe<double>& material :
       {metal(0.14, 4.1, "schlick"), metal(0.14, 4.1, "exact"), glass(1.5, "schlick"), glass(1.5, "exact")})
    for (double degrees = 0; degrees <= 180; degrees += 5) {
      Case c;
      c.normal =
          Vec3d(std::sin(degrees * std::numbers::pi / 180), 0, std::cos(degrees * std::numbers::pi / 180));
      const auto s = material.specular(c);
      EXPECT_LE(s.reflectance.x + s.transmittance.x, 1 + 1e-12) << degrees;
      EXPECT_GE(s.reflectance.x, 0) << degrees;
      EXPECT_GE(s.transmittance.x, 0) << degrees;
    }
}

}  // namespace
}  // namespace orrery::test
