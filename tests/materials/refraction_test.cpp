#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

constexpr double kRadians = std::numbers::pi / 180;
constexpr const char* kGlass = "{'type': 'refractive', 'ior': 1.5, 'fresnel': 'exact'}";

Case arriving(double degrees, double side) {
  Case c;
  c.direction = Vec3d(std::sin(degrees * kRadians), 0, -std::cos(degrees * kRadians));
  c.side = side;
  return c;
}
double angle_of(const Vec3d& direction) { return std::atan2(direction.x, -direction.z) / kRadians; }

TEST(Refraction, FollowsSnellsLaw) {
  covers("D4");
  const Probe<double> glass(kGlass);
  EXPECT_NEAR(angle_of(glass.specular(arriving(30, 1)).refracted), 19.471220634490692, 1e-10) << "in";
  EXPECT_NEAR(angle_of(glass.specular(arriving(30, -1)).refracted), 48.590377890729144, 1e-10) << "out";
  for (double degrees = 0; degrees < 90; degrees += 3) {
    const double within = std::asin(std::sin(degrees * kRadians) / 1.5) / kRadians;
    EXPECT_NEAR(angle_of(glass.specular(arriving(degrees, 1)).refracted), within, 1e-10);
    if (degrees > 86) continue;
    EXPECT_NEAR(angle_of(glass.specular(arriving(within, -1)).refracted), degrees, 1e-10);
  }
}

// The refracted ray continues through the surface, in the plane of the ray and the normal, from either side.
TEST(Refraction, ContinuesThroughSurface) {
  covers("D5");
  const Probe<double> glass(kGlass);
  Random random(1);
  std::vector<Case> cases(1'000'000);
  for (Case& c : cases) {
    c.normal = c.geometric = random.direction();
    c.direction = -random.direction_above(c.normal);
    c.side = random.below(2) ? 1 : -1;
  }
  const auto found = glass.specular(cases);
  int wrong_side = 0, out_of_plane = 0, not_unit = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (found[i].transmittance.x <= 0) continue;
    const Vec3d& t = found[i].refracted;
    wrong_side += !(dot(t, cases[i].normal) * dot(cases[i].direction, cases[i].normal) > 0);
    out_of_plane += std::abs(dot(t, cross(cases[i].normal, cases[i].direction))) > 1e-14;
    not_unit += std::abs(length(t) - 1) > 4e-16;
  }
  EXPECT_EQ(wrong_side, 0);
  EXPECT_EQ(out_of_plane, 0);
  EXPECT_EQ(not_unit, 0);
}

TEST(Refraction, ReflectsTotallyBeyondCriticalAngle) {
  covers("D3 R19");
  const Probe<double> glass(kGlass);
  const auto s = glass.specular(arriving(60, -1));
  EXPECT_EQ(s.reflectance, Vec3d(1));
  EXPECT_EQ(s.transmittance, Vec3d(0));
  double lowest = 30, highest = 60;  // critical angle, by bisection
  for (int i = 0; i < 60; ++i) {
    const double middle = (lowest + highest) / 2;
    (glass.specular(arriving(middle, -1)).transmittance.x > 0 ? lowest : highest) = middle;
  }
  EXPECT_NEAR(lowest, std::asin(1 / 1.5) / kRadians, 1e-10);
  EXPECT_NEAR(lowest, 41.810315, 5e-7);
}

TEST(Refraction, ConservesEnergy) {
  covers("D3");
  for (const char* text :
       {kGlass, "{'type': 'refractive', 'ior': 1.5}", "{'type': 'refractive', 'ior': 2.417}",
        "{'type': 'refractive', 'ior': 0.7, 'fresnel': 'exact'}"}) {
    const Probe<double> glass(text);
    std::vector<Case> cases;
    for (int i = 0; i < 10'000; ++i)
      for (const double side : {1.0, -1.0}) cases.push_back(arriving(i * 0.009, side));
    for (const auto& s : glass.specular(cases)) EXPECT_NEAR(s.reflectance.x + s.transmittance.x, 1, 1e-12);
  }
}

// Reflectance from inside under uniform light: R = .59635, of which total reflection is 1 - 1/n^2.
TEST(Refraction, MatchesDiffuseInternalReflectance) {
  covers("D3");
  const Probe<double> glass(kGlass);
  constexpr int kSteps = 200'000;
  std::vector<Case> cases(kSteps);
  for (int i = 0; i < kSteps; ++i) {
    const double sine2 = (i + 0.5) / kSteps;  // equal fractions of cosine-weighted light
    Case& c = cases[static_cast<std::size_t>(i)];
    c.side = -1;
    c.direction = Vec3d(std::sqrt(sine2), 0, -std::sqrt(1 - sine2));
  }
  double all = 0, total = 0;
  for (const auto& s : glass.specular(cases)) {
    all += s.reflectance.x / kSteps;
    total += (s.transmittance.x == 0) / static_cast<double>(kSteps);
  }
  EXPECT_NEAR(all, .59635, 1e-5);
  EXPECT_NEAR(total, 1 - 1 / 2.25, 1e-5);
}

TEST(Refraction, AttenuatesByDistanceInside) {
  covers("R24");
  const Probe<double> amber("{'type': 'refractive', 'ior': 1.5, 'filter': [0.5, 1, 0]}");
  Case c = arriving(20, -1);
  c.t = 3;
  EXPECT_NEAR(amber.specular(c).filter.x, 0.125, 1e-15);
  EXPECT_EQ(amber.specular(c).filter.y, 1);
  EXPECT_EQ(amber.specular(c).filter.z, 0);
  c.side = 1;
  EXPECT_EQ(amber.specular(c).filter, Vec3d(1)) << "outside the body nothing is filtered";
}

template <class T>
void million_rays() {
  const Probe<T> glass(kGlass);
  Random random(3);
  std::vector<typename Probe<T>::Case> cases(1'000'000);
  for (auto& c : cases) {
    const Vec3d normal = random.direction();
    c.normal = c.geometric = safe_normalize(Vec3<T>(normal));
    c.direction = -safe_normalize(Vec3<T>(random.below(8) ? random.direction_above(normal) : normal));
    c.side = static_cast<T>(random.below(2) ? 1 : -1);
  }
  int wrong = 0;
  for (const auto& s : glass.specular(cases)) {
    const T sum = s.reflectance.x + s.transmittance.x;
    const bool unit = std::abs(length(s.refracted) - 1) < 4 * std::numeric_limits<T>::epsilon();
    wrong += !(std::abs(sum - 1) < 4 * std::numeric_limits<T>::epsilon()) || (s.transmittance.x > 0 && !unit);
  }
  EXPECT_EQ(wrong, 0);
}
TEST(Refraction, ConservesEnergyAndDirectionLengthForMillionRays) {
  covers("A32");
  million_rays<float>();
  million_rays<double>();
}

}  // namespace
}  // namespace orrery::test
