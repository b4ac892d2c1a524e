#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

// Compares surfaces of revolution as NURBS with closed forms: an open tube, a sphere and a torus.
namespace orrery::test {
namespace {

using Exact = long double;
using ExactVec = Vec3<Exact>;

// Point of the curve that turns around the z axis.
struct ProfilePoint {
  double radius, z, weight;
};
const double kHalf = std::sqrt(0.5);  // weight of the corner of a quarter circle

// Returns the profile's surface of revolution. The turn has four quarters.
Json revolved(const std::vector<ProfilePoint>& profile, int degree, const std::vector<double>& knots) {
  constexpr double kTurn[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                  {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  Json points = Json::array(), weights = Json::array();
  for (const ProfilePoint& p : profile)
    for (int i = 0; i < 9; ++i) {
      points.push_back({p.radius * kTurn[i][0], p.radius * kTurn[i][1], p.z});
      weights.push_back(p.weight * (i % 2 ? kHalf : 1));
    }
  return {{"type", "nurbs"},  {"degree_u", 2},      {"degree_v", degree},
          {"points", points}, {"weights", weights}, {"knots_u", {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}},
          {"knots_v", knots}};
}

// Surface as NURBS and in closed form.
struct ClosedForm {
  const char* name;
  Json nurbs;
  std::function<Exact(const ExactVec&)> height;  // signed distance from the surface
  std::function<Vec3d(Random&, Vec3d&)> random;  // returns a point of the surface and its normal
  std::function<bool(const ExactVec&)> bounded;  // whether the surface ends beyond the point

  ExactVec normal(const ExactVec& p) const {
    constexpr Exact kStep = 1e-6L;
    ExactVec gradient;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ExactVec step(0);
      step[axis] = kStep;
      gradient[axis] = height(p + step) - height(p - step);
    }
    return safe_normalize(gradient);
  }
};

constexpr double kMajorRadius = 1, kMinorRadius = 0.375;

ClosedForm tube(double half) {
  return {"tube", revolved({{1, -half, 1}, {1, half, 1}}, 1, {0, 0, 1, 1}),
          [](const ExactVec& p) { return std::hypot(p.x, p.y) - 1; },
          [](Random& random, Vec3d& normal) {
            const double turn = random.between(0, 2 * std::numbers::pi);
            normal = {std::cos(turn), std::sin(turn), 0};
            return normal + Vec3d(0, 0, random.between(-0.99, 0.99));
          },
          [half](const ExactVec& p) { return std::abs(p.z) > half; }};
}

ClosedForm sphere() {
  return {"sphere",
          revolved({{0, -1, 1}, {1, -1, kHalf}, {1, 0, 1}, {1, 1, kHalf}, {0, 1, 1}}, 2,
                   {0, 0, 0, 1, 1, 2, 2, 2}),
          [](const ExactVec& p) { return length(p) - 1; },
          [](Random& random, Vec3d& normal) { return normal = random.direction(); },
          [](const ExactVec&) { return false; }};
}

ClosedForm ring() {
  std::vector<ProfilePoint> circle;
  constexpr double kTurn[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                  {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
  for (int i = 0; i < 9; ++i)
    circle.push_back(
        {kMajorRadius + kMinorRadius * kTurn[i][0], kMinorRadius * kTurn[i][1], i % 2 ? kHalf : 1});
  return {"torus", revolved(circle, 2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}),
          [](const ExactVec& p) {
            return std::hypot(std::hypot(p.x, p.y) - kMajorRadius, p.z) - Exact{kMinorRadius};
          },
          [](Random& random, Vec3d& normal) {
            const double turn = random.between(0, 2 * std::numbers::pi);
            const double around = random.between(0, 2 * std::numbers::pi);
            const Vec3d outward(std::cos(turn), std::sin(turn), 0);
            normal = outward * std::cos(around) + Vec3d(0, 0, std::sin(around));
            return outward * kMajorRadius + normal * kMinorRadius;
          },
          [](const ExactVec&) { return false; }};
}

// Distances at which the ray crosses the surface in [0, end), by sampling of the height and bisection.
// Crossings closer than `end` / kSamples are found if a sample is between them.
std::vector<Exact> crossings(const ClosedForm& form, const Ray<Exact>& ray, Exact end) {
  constexpr int kSamples = 512;
  std::vector<Exact> found;
  Exact before = form.height(ray.origin);
  for (int i = 1; i <= kSamples; ++i) {
    const Exact at = end * i / kSamples, height = form.height(ray.at(at));
    if ((height < 0) != (before < 0)) {
      Exact low = end * (i - 1) / kSamples, high = at;
      for (int step = 0; step < 60; ++step) {
        const Exact middle = (low + high) / 2;
        ((form.height(ray.at(middle)) < 0) == (before < 0) ? low : high) = middle;
      }
      if (!form.bounded(ray.at(high))) found.push_back(high);
    }
    before = height;
  }
  return found;
}

struct Worst {
  Exact distance = 0, normal = 0, off = 0, depth = 0;
  int compared = 0, hits = 0;
};

// Compares hits of rays that meet the surface at more than 6 degrees.
Worst compare_random(const ClosedForm& form, int rays) {
  const Target<double> target(scene_with(form.nurbs));
  Random random(1);
  Worst worst;
  Rays<double> cast;
  for (int i = 0; i < rays; ++i) {
    const Vec3d direction = random.direction();
    cast.push_back({random.in_cube(1.3) - direction * random.magnitude(0.1, 10), direction});
  }
  const auto hits = target.closest(cast);
  const auto spots = target.surfaces(cast, hits);
  for (std::size_t i = 0; i < cast.size(); ++i) {
    const auto ray = convert_ray<Exact>(cast[i]);
    const std::vector<Exact> exact = crossings(form, ray, 16);
    worst.hits += hits[i].met();
    if (exact.empty()) {
      if (hits[i].met()) worst.off = std::max(worst.off, std::abs(form.height(ray.at(hits[i].t))));
      continue;
    }
    const ExactVec normal = form.normal(ray.at(exact[0]));
    if (std::abs(dot(normal, ray.direction)) < 0.1L || std::abs(std::abs(ray.at(exact[0]).z) - 1) < 1e-9L)
      continue;
    ++worst.compared;
    const Exact t = hits[i].met() ? static_cast<Exact>(hits[i].t) : Exact{100};
    worst.distance = std::max(worst.distance, std::abs(t - exact[0]) / std::max(exact[0], Exact(1)));
    worst.normal = std::max(worst.normal, length(cross(ExactVec(spots[i].geometric), normal)));
  }
  return worst;
}

// Casts rays that touch the surface, tilted from the tangent plane by at most 1e-2 radians. A hit must be on
// the surface. A ray must not be deeper than `depth` in front of its hit, or anywhere if it misses.
Worst compare_grazing(const ClosedForm& form, int rays) {
  const Target<double> target(scene_with(form.nurbs));
  Random random(2);
  Worst worst;
  Rays<double> cast;
  std::vector<double> before;  // distance from the origin to the touched point
  for (int i = 0; i < rays; ++i) {
    Vec3d normal;
    const Vec3d point = form.random(random, normal);
    const double tilt = random.below(4) ? random.magnitude(1e-12, 1e-2) * (random.below(2) ? 1 : -1) : 0;
    const Vec3d along = safe_normalize(cross(normal, random.direction()));
    const Vec3d direction = safe_normalize(along + normal * tilt);
    before.push_back(random.magnitude(0.1, 10));
    cast.push_back({point - direction * before.back(), direction});
  }
  const auto hits = target.closest(cast);
  for (std::size_t i = 0; i < cast.size(); ++i) {
    const auto ray = convert_ray<Exact>(cast[i]);
    const Exact end = hits[i].met() ? static_cast<Exact>(hits[i].t) : Exact{20};
    worst.hits += hits[i].met();
    if (hits[i].met()) worst.off = std::max(worst.off, std::abs(form.height(ray.at(end))));
    // The ray may cross the surface near the touched point only, or far from it.
    const bool outside = form.height(ray.origin) > 0;
    const auto depth_at = [&](Exact t) {
      const Exact height = form.height(ray.at(t));
      return t < end && t > 0 && !form.bounded(ray.at(t)) ? outside ? -height : height : Exact{-1};
    };
    for (int k = 0; k < 128; ++k) {
      worst.depth = std::max(worst.depth, depth_at(20 * Exact(k) / 128));
      for (const Exact sign : {1.0L, -1.0L})
        worst.depth = std::max(worst.depth, depth_at(before[i] + sign * std::pow(0.8L, Exact(k))));
    }
  }
  return worst;
}

class Revolved : public testing::TestWithParam<int> {
 protected:
  // Grazing rays do not enter the tube of half length 16 by its ends.
  ClosedForm form(double half = 1) const {
    return GetParam() == 0 ? tube(half) : GetParam() == 1 ? sphere() : ring();
  }
};

TEST_P(Revolved, MatchesClosedFormTo1e12) {
  covers("A21 A22 A25");
  const int rays = exhaustive() ? 100'000 : 3'000;
  const Worst worst = compare_random(form(), rays);
  std::printf("%s of NURBS: distance %.2Lg, normal %.2Lg of %d hits\n", form().name, worst.distance,
              worst.normal, worst.compared);
  EXPECT_LE(worst.distance, 1e-12L);
  EXPECT_LE(worst.normal, 1e-7L);
  EXPECT_LE(worst.off, 1e-12L);
  EXPECT_GT(worst.compared, rays / 10);
}

TEST_P(Revolved, DecidesGrazingRaysWithin1e13) {
  covers("A23 A24");
  const int rays = exhaustive() ? 10'000 : 1'000;
  const Worst worst = compare_grazing(form(16), rays);
  std::printf("%s of NURBS, grazing rays: off the surface %.2Lg, missed depth %.2Lg of %d hits\n",
              form().name, worst.off, worst.depth, worst.hits);
  EXPECT_LE(worst.off, 1e-13L);
  EXPECT_LE(worst.depth, 1e-13L);
  EXPECT_GT(worst.hits, rays / 4);
}

INSTANTIATE_TEST_SUITE_P(Nurbs, Revolved, testing::Range(0, 3));

}  // namespace
}  // namespace orrery::test
