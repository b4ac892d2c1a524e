#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/materials.h"
#include "tests/support/random.h"

// Tests each term of Hall's model with its formula in long double.
namespace orrery::test {
namespace {

using Case = Probe<double>::Case;
using Real = long double;

struct Direction {
  Real x, y, z;
  explicit Direction(const Vec3d& v) : x(v.x), y(v.y), z(v.z) {}
  Direction(Real a, Real b, Real c) : x(a), y(b), z(c) {}
  Real dot(const Direction& o) const { return x * o.x + y * o.y + z * o.z; }
  Direction plus(const Direction& o, Real factor) const {
    return {x + o.x * factor, y + o.y * factor, z + o.z * factor};
  }
  Direction over(Real size) const { return {x / size, y / size, z / size}; }
  Real length() const { return std::sqrt(dot(*this)); }
};

constexpr Real kIndex = 1.5L, kNormal = 0.04L;

// Fresnel's reflectance; `ratio` is the index on the incident side over the other index.
Real fresnel(Real ratio, Real cosine) {
  const Real cos2 = 1 - ratio * ratio * (1 - cosine * cosine);
  if (cos2 <= 0) return 1;
  const Real other = std::sqrt(cos2);
  const Real s = (ratio * cosine - other) / (ratio * cosine + other);
  const Real p = (cosine - ratio * other) / (cosine + ratio * other);
  return (s * s + p * p) / 2;
}
Real tinted(Real f, Real color) {
  return color * kNormal + (1 - color * kNormal) * (f - kNormal) / (1 - kNormal);
}

// Random viewers above the surface, and lights above or below it, from outside or inside.
std::vector<Case> cases(bool below) {
  Random random(7);
  std::vector<Case> found(20'000);
  for (Case& c : found) {
    c.direction = -random.direction_above(c.normal);
    c.light = random.direction_above(c.normal);
    if (below) c.light.z = -c.light.z;
    c.side = random.below(2) ? 1 : -1;
  }
  return found;
}
// Returns the largest error relative to 1 of the red channel.
template <class Expected>
double worst_error(const char* material, bool below, const Expected& expected) {
  const auto points = cases(below);
  const auto found = Probe<double>(material).evaluated(points);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Case& c = points[i];
    const Real right = expected(Direction(-c.direction), Direction(c.light), c.side < 0);
    worst = std::max(worst, static_cast<double>(std::abs(found[i].pi_bsdf_cos.x - right)));
  }
  return worst;
}

TEST(Hall, ReflectsDiffuseLightOfFrontAndBack) {
  const char* both =
      "{'type': 'hall', 'kd': 0.5, 'diffuse_color': [0.8, 1, 1], 'kt_diffuse': 0.3, 'ks': 0, 'kt': 0}";
  EXPECT_LE(worst_error(both, false, [](auto, auto light, bool) { return 0.4L * light.z; }), 1e-15);
  EXPECT_LE(worst_error(both, true, [](auto, auto light, bool) { return -0.3L * light.z; }), 1e-15);
}

TEST(Hall, ColorsReflectedHighlightByFresnel) {
  const auto expected = [](Direction viewer, Direction light, bool inside) {
    const Direction sum = viewer.plus(light, 1), half = sum.over(sum.length());
    const Real f = fresnel(inside ? kIndex : 1 / kIndex, viewer.dot(half));
    return 0.7L * tinted(f, 0.5L) * std::pow(half.z, 12.0L);
  };
  const double worst =
      worst_error("{'type': 'hall', 'ks': 0.7, 'kt': 0, 'shininess': 12, 'reflection_color': [0.5, 1, 1]}",
                  false, expected);
  EXPECT_LE(worst, 1e-14);
  RecordProperty("worst_error", std::to_string(worst));
}

TEST(Hall, TransmitsHighlightAlongRefractingFacet) {
  const auto expected = [](Direction viewer, Direction light, bool inside) -> Real {
    const Real m = inside ? 1 / kIndex : kIndex;
    const Direction facet = viewer.plus(light, m).over(1 - m), half = facet.over(facet.length());
    if (half.z <= 0) return 0;
    return 0.9L * (1 - fresnel(1 / m, std::abs(viewer.dot(half)))) * std::pow(half.z, 7.0L);
  };
  const double worst =
      worst_error("{'type': 'hall', 'ks': 0, 'kt': 0.9, 'transmitted_shininess': 7}", true, expected);
  EXPECT_LE(worst, 1e-11) << "V + m L cancels near the axis";
  RecordProperty("worst_error", std::to_string(worst));
}

// The facet that refracts light from L toward V is the surface itself if V is the refracted direction of L.
TEST(Hall, PeaksAtRefractedDirection) {
  const Probe<double> hall("{'type': 'hall', 'ks': 0, 'kt': 1, 'transmitted_shininess': 1000}");
  Case c;
  const double sine = 0.6;
  c.direction = Vec3d(sine, 0, -0.8);
  const double inside = sine / 1.5;
  c.light = Vec3d(inside, 0, -std::sqrt(1 - inside * inside));
  EXPECT_NEAR(hall.evaluated(c).pi_bsdf_cos.x, 1 - static_cast<double>(fresnel(1 / kIndex, 0.8L)), 1e-9);
}

template <class T>
void expect_finite(double ior) {
  const Probe<T> hall(Json{{"type", "hall"}, {"ior", ior}, {"shininess", 5}});
  Random random(3);
  std::vector<typename Probe<T>::Case> points(100'000);
  for (auto& c : points) {
    c.direction = -safe_normalize(Vec3<T>(random.direction_above(Vec3d(0, 0, 1))));
    c.light = random.below(2) ? c.direction : safe_normalize(Vec3<T>(random.direction()));
    c.side = static_cast<T>(random.below(2) ? 1 : -1);
  }
  int wrong = 0;
  const auto found = hall.evaluated(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const T x = found[i].pi_bsdf_cos.x;
    wrong += !(std::isfinite(x) && x >= 0 && x <= 1);
    if (ior == 1 && points[i].light.z < 0) wrong += x != 0;
  }
  for (const auto& s : hall.specular(points))
    wrong +=
        !(std::isfinite(s.reflectance.x) && std::isfinite(s.transmittance.x) && std::isfinite(s.refracted.x));
  EXPECT_EQ(wrong, 0) << ior;
}
TEST(Hall, DropsTransmittedHighlightAtEqualIndices) {
  covers("E5");
  for (const double ior : {1.0, 1 + 1e-12, 1 - 1e-12, 1.0000001}) {
    expect_finite<float>(ior);
    expect_finite<double>(ior);
  }
}

TEST(Hall, SplitsRaysByFresnelAndFiltersThem) {
  const Probe<double> hall(
      "{'type': 'hall', 'ks': 0.8, 'kt': 0.5, 'reflection_color': [0.5, 1, 1], 'filter': [0.5, 1, 1]}");
  for (const double side : {1.0, -1.0})
    for (const double degrees : {0.0, 20.0, 40.0, 70.0}) {
      Case c;
      const double angle = degrees * std::numbers::pi / 180;
      c.direction = Vec3d(std::sin(angle), 0, -std::cos(angle));
      c.side = side;
      c.t = 3;
      const Real f = fresnel(side < 0 ? kIndex : 1 / kIndex, std::cos(static_cast<Real>(angle)));
      const Real filter = side < 0 ? 0.125L : 1;
      const auto found = hall.specular(c);
      EXPECT_NEAR(found.reflectance.x, static_cast<double>(0.8L * tinted(f, 0.5L) * filter), 1e-14);
      EXPECT_NEAR(found.reflectance.y, static_cast<double>(0.8L * f), 1e-14);
      EXPECT_NEAR(found.transmittance.x, static_cast<double>(0.5L * (1 - tinted(f, 0.5L)) * filter), 1e-14);
      EXPECT_EQ(found.filter, Vec3d(1)) << "the weights contain the filter";
    }
}

TEST(Hall, ReflectsAmbientLightThroughItsBody) {
  const Probe<double> hall("{'type': 'hall', 'kd': 0.5, 'ka': 0.2, 'filter': [0.5, 1, 1]}");
  Case c;
  c.t = 2;
  EXPECT_EQ(hall.ambient(c), Vec3d(0.2));
  c.side = -1;
  EXPECT_NEAR(hall.ambient(c).x, 0.05, 1e-15);
  EXPECT_EQ(hall.ambient(c).y, 0.2);
}

// A source and its mirrored image both count. The mean weight of samples has the same limit.
TEST(Hall, ReportsCreatedEnergy) {
  const Probe<double> hall("{'type': 'hall', 'kd': 0.5, 'kt_diffuse': 0.4, 'shininess': 4}");
  const double most = hall.limits().albedo.x;
  EXPECT_GT(most, 1.9);
  double largest = 0;
  for (const double side : {1.0, -1.0})
    for (const double cosine : {0.9375, 0.5625, 0.1875}) {
      Case c;
      c.direction = -tilted(cosine);
      c.side = side;
      double sum = 0;
      constexpr int kDraws = 200'000;
      for (const auto& drawn : hall.sampled(c, kDraws)) sum += drawn.weight.x / kDraws;
      EXPECT_LE(sum, most + 0.02) << side << cosine;
      largest = std::max(largest, sum);
    }
  EXPECT_GT(largest, most - 0.1);
}

}  // namespace
}  // namespace orrery::test
