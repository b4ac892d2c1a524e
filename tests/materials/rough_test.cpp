#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

namespace orrery::test {
namespace {

using Case = Probe<double>::Case;

// Returns a unit vector in the plane of x and z, `degrees` from the normal +z.
Vec3d tilted(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return {std::sin(a), 0, std::cos(a)};
}
Case lit_from(double light_degrees, double viewer_degrees) {
  Case c;
  c.light = tilted(light_degrees);
  c.direction = -tilted(viewer_degrees);
  return c;
}

constexpr const char* kDiffuse = "{'type': 'rough', 'kd': 1}";
constexpr const char* kPhong = "{'type': 'rough', 'kd': 0, 'ks': 1, 'shininess': 50, 'shading': 'phong'}";
constexpr const char* kBlinn = "{'type': 'rough', 'kd': 0, 'ks': 1, 'shininess': 50}";

TEST(Lambert, EqualsClampedCosine) {
  covers("B1");
  const Probe<double> white(kDiffuse);
  for (double degrees = -89; degrees < 90; degrees += 7)
    EXPECT_NEAR(white.reflected(lit_from(degrees, 10)).x, std::cos(degrees * std::numbers::pi / 180), 1e-15);
  EXPECT_EQ(white.reflected(lit_from(90.001, 0)).x, 0);
  EXPECT_EQ(white.reflected(lit_from(180, 0)).x, 0);
}

TEST(Rough, MultipliesCoefficientsByColours) {
  const Probe<double> paint(
      "{'type': 'rough', 'ka': 0.5, 'kd': [0.1, 0.2, 0.3], 'diffuse_color': [1, 0.5, 2], 'ks': 0.4, "
      "'specular_color': [0, 1, 0.5], "
      "'shininess': 1}");
  const Vec3d got = paint.reflected(Case{});  // light, viewer and normal coincide: every cosine is 1
  EXPECT_NEAR(got.x, 0.1, 1e-15);
  EXPECT_NEAR(got.y, 0.1 + 0.4, 1e-15);
  EXPECT_NEAR(got.z, 0.6 + 0.2, 1e-15);
  EXPECT_EQ(paint.ambient(), Vec3d(0.5, 0.25, 1));
  EXPECT_EQ(Probe<double>("{'type': 'rough', 'kd': 0.25}").ambient(), Vec3d(0.25)) << "ka defaults to kd";
}

TEST(Highlight, EqualsPowerOfCosine) {
  const Probe<double> phong(kPhong), blinn(kBlinn);
  for (double light = -80; light <= 80; light += 20)
    for (double viewer = -80; viewer <= 80; viewer += 10) {
      // Angle between mirrored direction and viewer.
      const double off = (light + viewer) * std::numbers::pi / 180;
      EXPECT_NEAR(phong.reflected(lit_from(light, viewer)).x, std::pow(std::max(0.0, std::cos(off)), 50),
                  1e-12);
      EXPECT_NEAR(blinn.reflected(lit_from(light, viewer)).x, std::pow(std::cos(off / 2), 50), 1e-12);
    }
}

TEST(Highlight, IsFiniteInDegenerateCases) {
  covers("B3 B4 B5");
  const auto of = [](const char* shading, double shininess) {
    return Probe<double>(
        Json{{"type", "rough"}, {"kd", 0}, {"ks", 1}, {"shininess", shininess}, {"shading", shading}});
  };
  for (const char* shading : {"phong", "blinn-phong"}) {
    // A negative cosine with a fractional exponent, and the exponent 0 with light behind and in front of the
    // surface.
    EXPECT_EQ(of("phong", 2.5).reflected(lit_from(50, 45)).x, 0);
    EXPECT_EQ(of(shading, 0).reflected(lit_from(120, 0)).x, 0);
    EXPECT_EQ(of(shading, 0).reflected(lit_from(30, 60)).x, 1);
    // Light arrives from below the surface, and the viewer is on the other side.
    Case under;
    under.normal = under.geometric = Vec3d(0, 1, 0);
    under.light = safe_normalize(Vec3d(.8, -.01, 0));
    under.direction = -safe_normalize(Vec3d(-1, .1, 0));
    EXPECT_EQ(of(shading, 50).reflected(under).x, 0);
    // The viewer is below the interpolated normal's horizon, and the light is above.
    EXPECT_EQ(of(shading, 2).reflected(lit_from(10, 95)).x, 0) << shading;
    // If light and viewer are exactly opposite, the half vector is zero.
    for (const double degrees : {-90.0, 0.0, 90.0}) {
      Case opposite = lit_from(degrees, 0);
      opposite.direction = opposite.light;
      EXPECT_FALSE(std::isnan(of(shading, 2.5).reflected(opposite).x));
    }
    Case through;
    through.light = safe_normalize(Vec3d(1, 0, 1));
    through.direction = through.light;
    EXPECT_EQ(of(shading, 50).reflected(through).x, 0) << shading;
  }
}

// The highlight falls to half its peak at 9.52 degrees from the mirrored direction for Phong, and at 19.04
// for Blinn-Phong. With exponent 4.02 n, Blinn-Phong agrees with Phong to 0.002.
TEST(Highlight, MatchesPhongAtFourfoldBlinnExponent) {
  covers("B7");
  const Probe<double> phong(kPhong), blinn(kBlinn);
  EXPECT_NEAR(phong.reflected(lit_from(0, 9.52)).x, 0.5, 1e-3);
  EXPECT_NEAR(blinn.reflected(lit_from(0, 19.04)).x, 0.5, 1e-3);
  const Probe<double> matched("{'type': 'rough', 'kd': 0, 'ks': 1, 'shininess': 201}");
  double largest = 0;
  for (double viewer = -89; viewer < 90; viewer += 0.05)
    largest = std::max(
        largest, std::abs(phong.reflected(lit_from(0, viewer)).x - matched.reflected(lit_from(0, viewer)).x));
  EXPECT_LE(largest, 0.002);
  EXPECT_GE(largest, 0.001) << "the factor 4.02 is an approximation";
}

// Dot products of normalized float vectors may exceed 1. No power and no root may become NaN.
template <class T>
void million_directions(const char* material) {
  using Cases = std::vector<typename Probe<T>::Case>;
  const Probe<T> probe(material);
  Random random(1);
  Cases cases(1'000'000);
  for (auto& c : cases) {
    const Vec3d normal = random.direction();
    c.normal = c.geometric = safe_normalize(Vec3<T>(normal));
    c.direction = -safe_normalize(Vec3<T>(random.below(4) ? random.direction_above(normal) : normal));
    c.light = random.below(4) ? safe_normalize(Vec3<T>(random.direction())) : -c.direction;
  }
  double largest = 0;
  for (const Vec3<T>& light : probe.reflected(cases)) {
    ASSERT_TRUE(std::isfinite(light.x) && light.x >= 0);
    largest = std::max(largest, static_cast<double>(light.x));
  }
  EXPECT_LE(largest, 2.000001);
}
TEST(Rough, StaysFiniteForMillionDirections) {
  covers("A32 B1 B3");
  million_directions<float>("{'type': 'rough', 'kd': 1, 'ks': 1, 'shininess': 2.5, 'shading': 'phong'}");
  million_directions<float>("{'type': 'rough', 'kd': 1, 'ks': 1, 'shininess': 1000000}");
  million_directions<double>("{'type': 'rough', 'kd': 1, 'ks': 1, 'shininess': 0.5}");
}

TEST(Rough, AgreesInFloatAndDouble) {
  const Probe<double> exact("{'type': 'rough', 'kd': 0.8, 'ks': 0.5, 'shininess': 100}");
  const Probe<float> single("{'type': 'rough', 'kd': 0.8, 'ks': 0.5, 'shininess': 100}");
  Random random(2);
  for (int i = 0; i < 2'000; ++i) {
    Case c;
    c.light = random.direction_above(c.normal);
    c.direction = -random.direction_above(c.normal);
    Probe<float>::Case f;
    f.light = Vec3f(c.light);
    f.direction = Vec3f(c.direction);
    // 100 ulp for the exponent 100, and the rounding errors of the vectors.
    EXPECT_NEAR(static_cast<double>(single.reflected(f).x), exact.reflected(c).x, 3e-5);
  }
}

// Light behind the geometric surface stays dark, even if it is in front of the interpolated normal.
TEST(Rough, IgnoresLightBehindGeometricSurface) {
  Case c;
  c.normal = tilted(60);
  c.geometric = Vec3d(0, 0, 1);
  c.light = tilted(100);
  EXPECT_EQ(Probe<double>(kDiffuse).reflected(c).x, 0);
  c.light = tilted(80);
  EXPECT_GT(Probe<double>(kDiffuse).reflected(c).x, 0);
}

}  // namespace
}  // namespace orrery::test
