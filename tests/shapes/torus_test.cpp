#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/math/hemisphere.h"
#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

// Compares the torus with a solver of its quartic in long double, which shares no code with the renderer.
namespace orrery::test {
namespace {

using Long = long double;
using LongVec = Vec3<Long>;

// Coefficients of a polynomial, the constant first.
using Polynomial = std::vector<Long>;

Long value_at(const Polynomial& p, Long x) {
  Long value = 0;
  for (std::size_t i = p.size(); i-- > 0;) value = value * x + p[i];
  return value;
}

// Returns the points in (low, high) where the polynomial changes its sign, by bisection between the roots of
// its derivative.
std::vector<Long> sign_changes(const Polynomial& p, Long low, Long high) {
  if (p.size() < 2) return {};
  Polynomial derivative;
  for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<Long>(i) * p[i]);
  std::vector<Long> knots = sign_changes(derivative, low, high), roots;
  knots.push_back(high);
  for (Long a = low; const Long end : knots) {
    Long b = end;
    if ((value_at(p, a) < 0) != (value_at(p, b) < 0)) {
      const bool falls = value_at(p, b) < 0;
      for (int step = 0; step < 70; ++step) {
        const Long middle = (a + b) / 2;
        ((value_at(p, middle) < 0) == falls ? b : a) = middle;
      }
      roots.push_back(b);
    }
    a = end;
  }
  return roots;
}

struct TorusSpec {
  Vec3d center, axis;
  double major, minor;

  Json object() const {
    return {{"type", "torus"},
            {"center", numbers(center)},
            {"axis", numbers(axis)},
            {"major_radius", major},
            {"minor_radius", minor}};
  }
  double reach() const { return max_component(abs(center)) + major + minor; }

  // Returns a random torus of size 1 near the origin, thin to thick.
  static TorusSpec random(Random& random) {
    const double minor = random.below(2) ? random.magnitude(1e-3, 0.3) : random.between(0.3, 0.999);
    return {random.in_cube(1), random.direction(), 1, minor};
  }
};

// The torus on one ray, in long double.
class TorusOnRay {
 public:
  TorusOnRay(const TorusSpec& torus, const Ray<Long>& ray) : torus_(torus), ray_(ray) {
    const LongVec u = ray.direction * (1 / length(ray.direction)), f = ray.origin - LongVec(torus.center);
    const LongVec axis = normalize(LongVec(torus.axis));
    start_ = dot(f, u);
    const LongVec g = f - u * start_;
    const Long major = torus.major, minor = torus.minor, slant = dot(u, axis), height = dot(g, axis);
    const Long m = dot(g, g) + major * major - minor * minor, four = 4 * major * major;
    quartic_ = {m * m - four * (dot(g, g) - height * height), 2 * four * height * slant,
                2 * m - four * (1 - slant * slant), 0, 1};
    for (std::size_t i = 1; i < quartic_.size(); ++i)
      derivative_.push_back(static_cast<Long>(i) * quartic_[i]);
  }

  // Returns the distance to the first hit, or infinity.
  Long hit() const {
    for (const Long s : sign_changes(quartic_, -kFar, kFar))
      if (s > start_) return (s - start_) / length(ray_.direction);
    return std::numeric_limits<Long>::infinity();
  }

  // Returns how far, in metres, the torus or the ray must move so that the first hit is at `t` (infinity: a
  // miss). That is the distance of the ray's point at `t` from the surface, and the greatest distance by
  // which the ray crosses the surface before `t`.
  Long error_of(Long t) const {
    const Long end = std::min(kFar, start_ + t * length(ray_.direction));
    const bool inside = height_at(0) < 0;
    Long error = std::isinf(t) ? 0 : std::abs(height_at(t));
    for (const Long s : sign_changes(derivative_, -kFar, kFar))
      if (s > start_ && s < end) {
        const Long height = height_at((s - start_) / length(ray_.direction));
        error = std::max(error, inside ? height : -height);
      }
    return inside && std::isinf(t) ? std::max(error, -height_at(0)) : error;
  }

 private:
  static constexpr Long kFar = 4;  // major radii; outside of every torus

  // Returns the distance of the ray's point at `t` from the surface, negative inside.
  Long height_at(Long t) const {
    const LongVec p = ray_.at(t) - LongVec(torus_.center), axis = normalize(LongVec(torus_.axis));
    const Long z = dot(p, axis);
    return std::hypot(length(p - axis * z) - static_cast<Long>(torus_.major), z) -
           static_cast<Long>(torus_.minor);
  }

  const TorusSpec torus_;
  const Ray<Long> ray_;
  Long start_;  // position of the origin on the ray, from the point nearest to the centre
  Polynomial quartic_, derivative_;
};

Ray<double> random_ray(Random& random, const TorusSpec& torus) {
  const Vec3d target = torus.center + random.in_cube(1.3 * (torus.major + torus.minor)),
              direction = random.direction();
  return {target - direction * random.magnitude(0.1, 10), direction};
}

// Returns a ray that touches the torus, tilted from the tangent plane by at most 1e-2 radians. A quarter of
// the rays touches the circles where the surface is flat in one direction.
Ray<double> tangent_ray(Random& random, const TorusSpec& torus) {
  const double turn = random.between(0, 2 * std::numbers::pi);
  const double around =
      random.below(4) ? random.between(0, 2 * std::numbers::pi) : std::numbers::pi / 2 * random.below(4);
  const Tangents<double> axes = tangents_of(torus.axis);
  const Vec3d outward = axes.first * std::cos(turn) + axes.second * std::sin(turn);
  const Vec3d normal = outward * std::cos(around) + torus.axis * std::sin(around);
  const Vec3d along = safe_normalize(cross(normal, random.direction()));
  const double tilt = random.below(4) ? random.magnitude(1e-10, 1e-2) * (random.below(2) ? 1 : -1) : 0;
  const Vec3d direction = safe_normalize(along + normal * tilt);
  const Vec3d point = torus.center + outward * torus.major + normal * torus.minor;
  return {point - direction * random.magnitude(0.1, 10), direction};
}

// Returns the largest error of the rays in rounding units: epsilon times the largest coordinate.
template <class T>
Long worst_error(int rays, std::uint64_t seed, Ray<double> (*ray_of)(Random&, const TorusSpec&)) {
  Random random(seed);
  Long worst = 0;
  constexpr int kRaysPerTorus = 1'000;
  for (int done = 0; done < rays; done += kRaysPerTorus) {
    const TorusSpec torus = TorusSpec::random(random);
    const Target<T> target(scene_with(torus.object()));
    Rays<T> cast;
    for (int i = 0; i < kRaysPerTorus; ++i) cast.push_back(convert_ray<T>(ray_of(random, torus)));
    const std::vector<Hit<T>> hits = target.closest(cast);
    for (std::size_t i = 0; i < cast.size(); ++i) {
      const auto ray = convert_ray<Long>(cast[i]);
      const Long unit = static_cast<Long>(std::numeric_limits<T>::epsilon()) *
                        std::max(static_cast<Long>(torus.reach()), max_component(abs(ray.origin)));
      worst = std::max(worst, TorusOnRay(torus, ray).error_of(static_cast<Long>(hits[i].t)) / unit);
    }
  }
  return worst;
}

constexpr Long kUnits = 4;  // permitted error

template <class T>
void check_errors(const char* type) {
  covers("A39");
  const Long random = worst_error<T>(exhaustive() ? 1'000'000 : 20'000, 1, random_ray);
  const Long tangent = worst_error<T>(exhaustive() ? 100'000 : 20'000, 2, tangent_ray);
  std::printf("torus in %s, rounding units: random rays %.3Lf, tangent rays %.3Lf\n", type, random, tangent);
  EXPECT_LE(random, kUnits);
  EXPECT_LE(tangent, kUnits);
}

TEST(Torus, MatchesQuarticWithinRoundingUnitsInFloat) { check_errors<float>("float"); }
TEST(Torus, MatchesQuarticWithinRoundingUnitsInDouble) { check_errors<double>("double"); }

// Compares distances along rays that meet the surface at more than 6 degrees.
TEST(Torus, FindsDistancesTo1e12InDouble) {
  Random random(3);
  Long worst = 0;
  int compared = 0;
  const int rays = exhaustive() ? 1'000'000 : 20'000;
  constexpr int kRaysPerTorus = 1'000;
  for (int done = 0; done < rays; done += kRaysPerTorus) {
    const TorusSpec torus = TorusSpec::random(random);
    const Target<double> target(scene_with(torus.object()));
    for (int i = 0; i < kRaysPerTorus; ++i) {
      const Ray<double> ray = random_ray(random, torus);
      const Long exact = TorusOnRay(torus, convert_ray<Long>(ray)).hit();
      const Hit<double> hit = target.closest(ray);
      if (!hit.met() || std::abs(dot(target.surface(ray, hit).geometric, ray.direction)) < 0.1) continue;
      worst = std::max(worst, std::abs(static_cast<Long>(hit.t) - exact) / std::max(exact, Long(1)));
      ++compared;
    }
  }
  std::printf("torus in double: largest relative error %.3Lg of %d hits\n", worst, compared);
  EXPECT_LE(worst, 1e-12L);
  EXPECT_GT(compared, rays / 10);
}

// Rays along an axis of the torus, in planes of symmetry, and along surfaces.
TEST(Torus, HitsInSpecialPositions) {
  const auto shape = Target<double>::of_objects(
      "[{'type': 'torus', 'center': [0, 0, 0], 'axis': [0, 0, 1], 'major_radius': 2, 'minor_radius': 0.5}]");
  const auto distance = [&](const Vec3d& from, const Vec3d& direction) {
    return shape.closest(Ray<double>{from, direction}).t;
  };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double side : {1.0, -1.0}) {
    EXPECT_EQ(distance({0, 0, 5 * side}, {0, 0, -side}), infinity) << "through the hole";
    EXPECT_EQ(distance({0, 0, 0}, {0, 0, side}), infinity) << "from the centre";
    EXPECT_NEAR(distance({2 * side, 0, 5}, {0, 0, -1}), 4.5, 1e-14) << "onto the top";
    EXPECT_NEAR(distance({5 * side, 0, 0}, {-side, 0, 0}), 2.5, 1e-14) << "onto the outer equator";
    EXPECT_NEAR(distance({0, 0, 0}, {0, side, 0}), 1.5, 1e-14) << "onto the inner equator";
    EXPECT_NEAR(distance({2 * side, 0, 0}, {side, 0, 0}), 0.5, 1e-14) << "from inside, outward";
    EXPECT_NEAR(distance({2 * side, 0, 0}, {-side, 0, 0}), 0.5, 1e-14) << "from inside, inward";
    EXPECT_NEAR(distance({2 * side, 0, 0}, {0, 1, 0}), 1.5, 1e-14) << "from inside, along the tube";
    EXPECT_NEAR(distance({1.5 * side, -5, 0}, {0, 1, 0}), 3, 1e-14) << "touches the inner equator later";
    EXPECT_EQ(distance({5, 5 * side, 0.5 + 1e-12}, safe_normalize(Vec3d(-1, -side, 0))), infinity);
    EXPECT_NEAR(distance({5, 0, 0.5 - 1e-12}, {-1, 0, 0}), 3 - std::sqrt(1e-12), 1e-9) << "below the top";
    EXPECT_EQ(distance({5, 2.5 * side + 1e-14 * side, 0}, {-1, 0, 0}), infinity)
        << "just outside the equator";
  }
}

// A ray in the plane through the centre at an angle of asin(r / R) to the equator touches the tube twice and
// runs along two circles (Villarceau).
TEST(Torus, HitsOnBitangentPlane) {
  const double major = 2, minor = 0.5, sine = minor / major, cosine = std::sqrt(1 - sine * sine);
  const auto shape = Target<double>::of_objects(
      "[{'type': 'torus', 'center': [0, 0, 0], 'axis': [0, 0, 1], 'major_radius': 2, 'minor_radius': 0.5}]");
  // In the plane, the circles have the radius `major` and their centres at -+ minor on the y axis.
  const Vec3d first(cosine, 0, sine), second(0, 1, 0);
  Random random(4);
  for (int i = 0; i < 1'000; ++i) {
    const double x = random.between(-major, major);
    const double exact = 5 - (minor + std::sqrt(major * major - x * x));
    const double t = shape.closest(Ray<double>{first * x + second * 5, -second}).t;
    ASSERT_NEAR(t, exact, 1e-12 / std::sqrt(1 - std::abs(x) / major)) << x;
  }
}

TEST(Torus, AcceptsDirectionsOfAnyLength) {
  const auto shape = Target<double>::of_objects(
      "[{'type': 'torus', 'center': [0, 0, 0], 'axis': [1, 2, 3], 'major_radius': 2, 'minor_radius': 0.5}]");
  const Vec3d axis = safe_normalize(Vec3d(1, 2, 3)), outward = perpendicular(axis);
  for (const double length : {1e-6, 0.5, 3.0, 1e6})
    EXPECT_NEAR(shape.closest(Ray<double>{outward * 5, outward * -length}).t * length, 2.5, 1e-12) << length;
}

TEST(Torus, HasTightBounds) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const TorusSpec torus = TorusSpec::random(random);
    const Boundsd box = Target<double>(scene_with(torus.object())).bounds(0);
    Boundsd sampled;
    for (std::size_t k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        // The extreme point in direction k is the extreme point of the circle, plus the minor radius.
        Vec3d toward(0);
        toward[k] = sign;
        const Vec3d across = toward - torus.axis * dot(toward, torus.axis);
        sampled.include(torus.center + safe_normalize(across) * torus.major + toward * torus.minor);
      }
    EXPECT_LE(max_component(abs(box.lo - sampled.lo)), 4e-15);
    EXPECT_LE(max_component(abs(box.hi - sampled.hi)), 4e-15);
  }
}

}  // namespace
}  // namespace orrery::test
