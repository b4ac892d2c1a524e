#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/hemisphere.h"
#include "tests/support/covers.h"
#include "tests/support/exhaustive.h"
#include "tests/support/random.h"
#include "tests/support/rays.h"

// Compares the cone with its signed height function in long double. The function is convex, so bisection and
// ternary search suffice. Nothing is shared with the renderer.
namespace orrery::test {
namespace {

struct ConeSpec {
  Vec3d base, top;
  double base_radius, top_radius;

  Json object() const {
    return {{"type", "cone"},
            {"base", numbers(base)},
            {"top", numbers(top)},
            {"base_radius", base_radius},
            {"top_radius", top_radius}};
  }
  Vec3d axis() const { return safe_normalize(top - base); }
  double reach() const {
    return std::max(max_component(abs(base)) + base_radius, max_component(abs(top)) + top_radius);
  }

  // Returns a random cone of size 1 near the origin: half of them with a tip, needles to flat ones.
  static ConeSpec random(Random& random) {
    const Vec3d base = random.in_cube(1), axis = random.direction();
    const double height = random.magnitude(1e-2, 2), radius = random.magnitude(1e-2, 1);
    const double other = random.below(2) ? 0 : random.below(4) ? random.magnitude(1e-2, 1) : radius;
    return {base, base + axis * height, radius, other};
  }
};

// The cone on one ray, in long double.
class ConeOnRay {
 public:
  using Number = long double;

  ConeOnRay(const ConeSpec& cone, const Ray<Number>& ray)
      : cone_(cone), ray_(ray), base_(cone.base), axis_(Vec3<Number>(cone.top) - base_) {
    height_ = length(axis_);
    axis_ = axis_ * (1 / height_);
    growth_ = (static_cast<Number>(cone.top_radius) - static_cast<Number>(cone.base_radius)) / height_;
    const Number speed = length(ray.direction);
    const Number nearest = -dot(ray.origin - base_, ray.direction) / (speed * speed);
    begin_ = std::max(Number(0), nearest - kReach / speed);
    end_ = std::max(Number(0), nearest + kReach / speed);
  }

  // Returns how far, in metres, the cone or the ray must move so that the first hit is at `t` (infinity: a
  // miss). That is the distance of the ray's point at `t` from the surface, and the greatest depth of the
  // ray's points before `t` inside the cone, if the origin is outside.
  Number error_of(Number t) const {
    const bool miss = std::isinf(t);
    const Number error = miss ? 0 : std::abs(height_at(t));
    if (height_at(0) < 0) return miss ? -height_at(0) : error;
    return std::max(error, -least_height(begin_, std::min(end_, t)));
  }

 private:
  static constexpr Number kReach = 8;  // more than the size of any cone

  // Returns a convex function of the ray's point at `t`: its distance from the nearest face, negative inside.
  Number height_at(Number t) const {
    const Vec3<Number> p = ray_.at(t) - base_;
    const Number along = dot(p, axis_), cosine = 1 / std::sqrt(1 + growth_ * growth_);
    const Number rho = static_cast<Number>(cone_.base_radius) + growth_ * along;
    return std::max({(length(p - axis_ * along) - rho) * cosine, -along, along - height_});
  }

  Number least_height(Number low, Number high) const {
    for (int step = 0; step < 150 && low < high; ++step) {
      const Number a = low + (high - low) / 3, b = high - (high - low) / 3;
      (height_at(a) < height_at(b) ? high : low) = height_at(a) < height_at(b) ? b : a;
    }
    return height_at(low);
  }

  const ConeSpec cone_;
  const Ray<Number> ray_;
  Vec3<Number> base_, axis_;
  Number height_, growth_, begin_, end_;
};

Ray<double> ray_near(Random& random, const ConeSpec& cone) {
  const Vec3d middle = (cone.base + cone.top) / 2, direction = random.direction();
  const double size = cone.base_radius + cone.top_radius + length(cone.top - cone.base);
  return {middle + random.in_cube(size / 2) - direction * random.magnitude(0.1, 10), direction};
}

// Returns a ray through a point of the wall, a tip or a rim, tilted from the tangent plane by at most 1e-2
// radians. A quarter of the rays runs along the straight lines of the wall.
Ray<double> ray_touching(Random& random, const ConeSpec& cone) {
  const double turn = random.between(0, 2 * std::numbers::pi), height = length(cone.top - cone.base);
  const double part = random.below(3) ? random.unit() : random.below(2);
  const double radius = cone.base_radius + (cone.top_radius - cone.base_radius) * part;
  const Vec3d axis = cone.axis();
  const Tangents<double> axes = tangents_of(axis);
  const Vec3d outward = axes.first * std::cos(turn) + axes.second * std::sin(turn);
  const Vec3d normal = safe_normalize(outward * height + axis * (cone.base_radius - cone.top_radius));
  const Vec3d line = cross(normal, cross(outward, axis));
  const Vec3d along = random.below(4) ? safe_normalize(cross(normal, random.direction())) : line;
  const double tilt = random.below(4) ? random.magnitude(1e-10, 1e-2) * (random.below(2) ? 1 : -1) : 0;
  const Vec3d direction = safe_normalize(along + normal * tilt);
  const Vec3d point = cone.base + axis * (height * part) + outward * radius;
  return {point - direction * random.magnitude(0.1, 10), direction};
}

// Returns a ray parallel to the axis, inside the cone or past it.
Ray<double> ray_along_axis(Random& random, const ConeSpec& cone) {
  const Vec3d axis = cone.axis() * (random.below(2) ? 1 : -1);
  const Vec3d aside = perpendicular(axis) * random.between(0, 1.5 * (cone.base_radius + cone.top_radius));
  return {(cone.base + cone.top) / 2 + aside - axis * random.between(-1, 10), axis};
}

// Returns the largest error of the rays in rounding units: epsilon times the largest coordinate.
template <class T>
long double worst_cone_error(int rays, Ray<double> (*ray_of)(Random&, const ConeSpec&)) {
  Random random(7);
  long double worst = 0;
  constexpr int kRaysPerCone = 100;
  for (int done = 0; done < rays; done += kRaysPerCone) {
    const ConeSpec cone = ConeSpec::random(random);
    const Target<T> target(scene_with(cone.object()));
    Rays<T> cast;
    for (int i = 0; i < kRaysPerCone; ++i) cast.push_back(convert_ray<T>(ray_of(random, cone)));
    const std::vector<Hit<T>> hits = target.closest(cast);
    for (std::size_t i = 0; i < cast.size(); ++i) {
      const auto ray = convert_ray<long double>(cast[i]);
      const long double unit =
          static_cast<long double>(std::numeric_limits<T>::epsilon()) *
          std::max(static_cast<long double>(cone.reach()), max_component(abs(ray.origin)));
      worst = std::max(worst, ConeOnRay(cone, ray).error_of(static_cast<long double>(hits[i].t)) / unit);
    }
  }
  return worst;
}

template <class T>
void check_cone_errors(const char* type) {
  covers("A40");
  constexpr long double kUnits = 4;  // permitted error
  const int rays = exhaustive() ? 1'000'000 : 20'000;
  const long double near = worst_cone_error<T>(rays, ray_near),
                    touching = worst_cone_error<T>(rays / 10 + 10'000, ray_touching),
                    parallel = worst_cone_error<T>(rays / 10, ray_along_axis);
  std::printf("cone in %s, rounding units: random rays %.3Lf, tangent rays %.3Lf, parallel rays %.3Lf\n",
              type, near, touching, parallel);
  EXPECT_LE(near, kUnits);
  EXPECT_LE(touching, kUnits);
  EXPECT_LE(parallel, kUnits);
}

TEST(Cone, MatchesHeightFunctionWithinRoundingUnitsInFloat) { check_cone_errors<float>("float"); }
TEST(Cone, MatchesHeightFunctionWithinRoundingUnitsInDouble) { check_cone_errors<double>("double"); }

// A cone of base radius 1 at z = 0 with its tip at z = 2.
constexpr const char* kTipped = "[{'type': 'cone', 'base': [0, 0, 0], 'top': [0, 0, 2], 'base_radius': 1}]";

template <class T>
T distance_to_tipped(const Vec3<T>& from, const Vec3<T>& direction) {
  static const auto shape = Target<T>::of_objects(kTipped);
  return shape.closest(Ray<T>{from, direction}).t;
}

TEST(Cone, HitsWallCapAndTip) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto distance = distance_to_tipped<double>;
  EXPECT_EQ(distance({0.25, 0, 5}, {0, 0, -1}), 3.5) << "onto the wall";
  EXPECT_EQ(distance({0.25, 0, -5}, {0, 0, 1}), 5) << "onto the cap";
  EXPECT_EQ(distance({0.25, 0, 0.5}, {0, 0, 1}), 1) << "from inside, up";
  EXPECT_EQ(distance({0.25, 0, 0.5}, {0, 0, -1}), 0.5) << "from inside, down";
  EXPECT_EQ(distance({0, 0, 5}, {0, 0, -1}), 3) << "onto the tip";
  EXPECT_EQ(distance({0, 0, 2}, {0, 0, -1}), 2) << "from the tip down";
  EXPECT_EQ(distance({0, 0, 2}, {0, 0, 1}), infinity) << "from the tip up";
  EXPECT_EQ(distance({-5, 0, 1}, {1, 0, 0}), 4.5);
  EXPECT_EQ(distance({-5, 0, 2.125}, {1, 0, 0}), infinity) << "above the tip, in the other half";
  EXPECT_EQ(distance({-5, 0, 3}, {1, 0, -0.25}), 5.5 / 1.125) << "slanted";
  EXPECT_EQ(distance({0, 0, 4}, {0.125, 0, -1}), 2 / 0.75) << "through the other half, past the tip";
}

// A ray in the plane of the cap, or along a straight line of the wall, meets the edge of the cone.
TEST(Cone, HitsEdgesInPlaneOfCapAndAlongWall) {
  EXPECT_EQ(distance_to_tipped<double>({-5, 0, 0}, {1, 0, 0}), 4);
  EXPECT_EQ(distance_to_tipped<float>({-5, 0, 0}, {1, 0, 0}), 4);
  EXPECT_EQ(distance_to_tipped<double>({-1, 0, 4}, {0.5, 0, -1}), 2) << "along the wall from the tip down";
  EXPECT_EQ(distance_to_tipped<double>({1.5, 0, -1}, {-0.5, 0, 1}), 1) << "along the wall from the rim up";
  EXPECT_EQ(distance_to_tipped<double>({1.51, 0, -1}, {-0.5, 0, 1}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(distance_to_tipped<double>({1.25, 0, -1}, {-0.5, 0, 1}), 1) << "parallel to the wall, inside";
}

// A frustum of equal radii is a cylinder.
TEST(Cone, EqualsCylinderForEqualRadii) {
  const auto cone = Target<double>::of_objects(
      "[{'type': 'cone', 'base': [0, 1, 0], 'top': [1, 2, 3], 'base_radius': 0.5, 'top_radius': 0.5}]");
  const auto cylinder = Target<double>::of_objects(
      "[{'type': 'cylinder', 'base': [0, 1, 0], 'top': [1, 2, 3], 'radius': 0.5}]");
  Random random(8);
  int hits = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Vec3d direction = random.direction();
    const Ray<double> ray{Vec3d(0.5, 1.5, 1.5) + random.in_cube(1.5) - direction * 5, direction};
    const auto ours = cone.closest(ray), theirs = cylinder.closest(ray);
    ASSERT_EQ(ours.met(), theirs.met());
    if (!ours.met()) continue;
    ASSERT_NEAR(ours.t, theirs.t, 1e-9);  // near an outline, rounding errors grow
    ++hits;
  }
  EXPECT_GT(hits, 1'000);
}

TEST(Cone, HasTightBounds) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    const ConeSpec cone = ConeSpec::random(random);
    const Boundsd box = Target<double>(scene_with(cone.object())).bounds(0);
    Boundsd extremes;
    for (std::size_t k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        Vec3d toward(0);
        toward[k] = sign;
        const Vec3d across = safe_normalize(toward - cone.axis() * dot(toward, cone.axis()));
        extremes.include(cone.base + across * cone.base_radius);
        extremes.include(cone.top + across * cone.top_radius);
      }
    EXPECT_LE(max_component(abs(box.lo - extremes.lo)), 4e-15);
    EXPECT_LE(max_component(abs(box.hi - extremes.hi)), 4e-15);
  }
}

}  // namespace
}  // namespace orrery::test
